# A second build fits only what has changed; other options fit all anew; the archive is the same as one made at once.
fixture alpha beta gamma
mkdir in && mv *.binary in
reused() { tail -n 1 | sed 's/.*"materials": *\([0-9]*\), *"reused": *\([0-9]*\).*/\1 materials, \2 reused/'; }
build --update --json -o out.bpk in | reused
cp out.bpk first.bpk
build --update --json -o out.bpk in | reused
cmp first.bpk out.bpk && echo "the same bytes"
cp in/alpha.binary in/gamma.binary
build --update --json -o out.bpk in | reused
build -o fresh.bpk in
cmp fresh.bpk out.bpk && echo "as if built anew"
rm in/beta.binary
build --update --json -j 2 -o out.bpk in | reused
build --update --json --effort 4 -o out.bpk in | reused
build --json -o out.bpk in | reused
build -q --profile paper -o fresh.bpk in
brdfpack subset -q --max-error 1 -o out.bpk fresh.bpk
build --update --profile paper --json -o out.bpk in | reused
cmp fresh.bpk out.bpk && echo "records that lost layers are not reused"
echo "not an archive" >other.bpk
code build --update -o other.bpk in
cat other.bpk
