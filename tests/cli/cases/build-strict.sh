# With --strict one refused material means no archive, and an older one stays as it is.
fixture alpha truncated
code build --strict -o out.bpk .
ls
build -o out.bpk alpha.binary && cp out.bpk before
code build --strict -o out.bpk .
cmp out.bpk before && echo untouched
