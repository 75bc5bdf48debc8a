# An output that is one of the inputs, by whatever name, is refused before any work; --force replaces it.
fixture alpha beta gamma
build -q -o a.bpk alpha.binary
build -q -o b.bpk beta.binary
cp -r . ../kept
printf 'alpha\nbeta\n' >list.txt && cp list.txt ../kept
printf '"alpha"' >scene.json && cp scene.json ../kept
ln alpha.binary hard.binary
ln -s alpha.binary soft.binary
ln -s . here
unchanged() { (cd ../kept && find . -type f) | while read -r file; do cmp "$file" "../kept/$file"; done; }
code build -o alpha.binary beta.binary gamma.binary
code build -o alpha.binary alpha.binary beta.binary
code build -o hard.binary alpha.binary beta.binary
code build -o soft.binary alpha.binary beta.binary
code build -o here/./alpha.binary alpha.binary beta.binary
code build -o list.txt --manifest list.txt .
code build -o alpha.binary .
tar cf in.tar beta.binary && cp in.tar ../kept && code build -o in.tar in.tar
code brdfpack merge -o a.bpk a.bpk b.bpk
code brdfpack merge -o here/b.bpk a.bpk b.bpk
code brdfpack subset -o a.bpk a.bpk
code brdfpack subset -o scene.json --scene scene.json a.bpk
code brdfpack recover -o a.bpk a.bpk
cp alpha.binary picture.png && cp picture.png ../kept
code brdfpack render -o picture.png picture.png
code brdfpack show -o picture.png picture.png
code brdfpack show -o picture.png --measured picture.png a.bpk alpha
unchanged
rm -r ../kept
code brdfpack subset --force -o a.bpk a.bpk alpha
code brdfpack merge --force -q -o a.bpk a.bpk b.bpk
code brdfpack recover --force -o a.bpk a.bpk
code build --force -o alpha.binary alpha.binary beta.binary
brdfpack list --json alpha.binary | sed 's/,.*//'
code brdfpack show --force -o picture.png picture.png
head -c 4 picture.png | tail -c 3
