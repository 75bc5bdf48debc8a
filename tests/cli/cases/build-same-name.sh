# Two inputs of one name: refused before any work, both paths named, no archive.
fixture alpha beta
mkdir a b && cp alpha.binary a && cp beta.binary b/alpha.binary
code build -o out.bpk a b beta.binary
tar czf a.tar.gz a && tar cf b.tar b
code build -o out.bpk a.tar.gz b
code build -o out.bpk beta.binary b.tar a.tar.gz
ls
