# What was extracted can be packed again.
fixture alpha
build -o out.bpk alpha.binary
brdfpack extract -C x out.bpk
code build -o again.bpk x
brdfpack list again.bpk | cut -d ' ' -f 1
