# The same name twice in a stream: the first is packed, the second named, and the others after it are packed.
fixture alpha beta gamma
mkdir a b c && cp alpha.binary a/same.binary && cp beta.binary b/same.binary && mv gamma.binary c
tar czf in.tar.gz a b c
code build -o out.bpk in.tar.gz
brdfpack list out.bpk | cut -d ' ' -f 1
build -q -o first.bpk a c && cmp out.bpk first.bpk && echo "the first"
code build --json -j1 -o out.bpk in.tar.gz 2>/dev/null | grep -o '^{"name": "[a-z]*", "path": "[^"]*", "[a-z]*"'
code build --strict -o strict.bpk in.tar.gz
[ ! -e strict.bpk ] && echo "nothing was written"
