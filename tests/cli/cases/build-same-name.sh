# Two inputs of one name: the first in the order of paths is packed, whatever the order of the inputs; both are named.
fixture alpha beta
mkdir a b && cp alpha.binary a && cp beta.binary b/alpha.binary
code build -o out.bpk a b beta.binary
code build -q -o other.bpk b beta.binary a
cmp out.bpk other.bpk && echo "the same archive"
code build --strict -o strict.bpk a b
tar czf a.tar.gz a && tar cf b.tar b
code build -o out.bpk a.tar.gz b
code build -o out.bpk beta.binary b.tar a.tar.gz
ls
