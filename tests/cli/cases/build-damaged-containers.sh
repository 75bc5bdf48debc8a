# A container that is cut in the middle: what is whole is packed, the rest is reported, exit 1.
fixture alpha beta gamma
tar cf all.tar alpha.binary beta.binary gamma.binary
head -c 20000 all.tar >cut.tar
code build -o tar.bpk cut.tar
brdfpack list tar.bpk | cut -d ' ' -f 1
tar czf all.tar.gz alpha.binary beta.binary gamma.binary
head -c $(($(stat -c %s all.tar.gz) * 4 / 5)) all.tar.gz >cut.tar.gz
code build -o targz.bpk cut.tar.gz
python3 -m zipfile -c all.zip alpha.binary beta.binary gamma.binary
head -c $(($(stat -c %s all.zip) * 4 / 5)) all.zip >cut.zip
code build -o zip.bpk cut.zip
