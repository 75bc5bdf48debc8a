# A file whose SHA-256 is not the manifest's is refused by name, with both hashes.
fixture alpha beta
a=$(sha256sum alpha.binary | cut -d ' ' -f 1)
printf 'alpha\t\t%s\nbeta\t\t%s\n' "$a" "$a" >list.tsv
code build --manifest list.tsv -o out.bpk .
brdfpack list out.bpk | cut -d ' ' -f 1
