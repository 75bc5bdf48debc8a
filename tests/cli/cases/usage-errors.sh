# A wrong command line: exit code 2, the option's name, where the help is. Nothing is written.
code brdfpack build
code brdfpack build -o out.bpk
code brdfpack build x.binary
code brdfpack build -o
code brdfpack build -o out.bpk -j 0 x
code brdfpack build -o out.bpk -j 1.5 x
code brdfpack build -o out.bpk -j 257 x
code brdfpack build -o out.bpk -j ' 2' x
code brdfpack build -o out.bpk --budget 999 x
code brdfpack build -o out.bpk --budget 5MB x
code brdfpack build -o out.bpk --budget 10kx x
code brdfpack build -o out.bpk --budget 99999999999999999999 x
code brdfpack build -o out.bpk --max-error nan x
code brdfpack build -o out.bpk --max-error -1 x
code brdfpack build -o out.bpk --max-error 0.1 --budget 4000 x
code brdfpack build -o out.bpk --effort 10 x
code brdfpack build -o out.bpk --profile best x
code brdfpack build -o out.bpk --nonsense x
code brdfpack build -o out.bpk --strict=yes x
code brdfpack build -o out.bpk -x x
code brdfpack list
code brdfpack list --jso x.bpk --q
code brdfpack extract
code brdfpack extract --format png a.bpk
code brdfpack verify
code brdfpack verify a b
code brdfpack synth
ls
