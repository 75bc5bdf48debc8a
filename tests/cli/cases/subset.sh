# Named materials, each once and in name order; all of them; records byte for byte; a missing name writes nothing.
fixture alpha beta gamma
build -o all.bpk .
brdfpack subset -o some.bpk all.bpk gamma alpha gamma | sed 's/[0-9]* of [0-9]* bytes/N of N bytes/'
brdfpack list --json some.bpk | sed -n 's/.*"name": *"\([^"]*\)".*/\1/p'
brdfpack subset -q -o same.bpk all.bpk
cmp all.bpk same.bpk && echo "a subset of all is the same archive"
brdfpack verify --deep some.bpk
brdfpack extract -C a all.bpk gamma
brdfpack extract -C b some.bpk gamma
cmp a/gamma.binary b/gamma.binary && echo "the same values"
code brdfpack subset -o none.bpk all.bpk gamma gama
[ ! -e none.bpk ] && echo "nothing was written"
code brdfpack subset all.bpk
code brdfpack subset -o out.bpk --max-error zero all.bpk
code brdfpack subset -o out.bpk missing.bpk
code brdfpack subset -o no/such/folder.bpk all.bpk alpha
