# The digest of the whole file, to sign or to compare.
fixture alpha
build -o out.bpk .
[ "$(brdfpack list --sha256 out.bpk | tail -n 1)" = "SHA-256 $(sha256sum <out.bpk | cut -d' ' -f1)" ] && echo "as sha256sum has it"
brdfpack list --sha256 --json out.bpk alpha | tail -n 1 | grep -c "\"sha256\": \"$(sha256sum <out.bpk | cut -d' ' -f1)\""
