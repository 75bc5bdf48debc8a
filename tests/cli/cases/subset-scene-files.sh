# Scenes that name the measured files, in the ways of pbrt, Mitsuba, JSON and USD, mean their materials; files that are not there are told.
fixture alpha beta gamma
cp alpha.binary 'two words.binary'
cp alpha.binary 'x.binary.binary'
build -q -o all.bpk .
names() { brdfpack list --json "$1" | sed -n 's/.*"name": *"\([^"]*\)".*/\1/p' | tr '\n' ' '; echo; }
echo 'Material "measured" "string filename" [ "brdfs/alpha.binary" ]' >scene.pbrt
echo '<bsdf type="merl"><string name="filename" value="beta.binary"/></bsdf>' >scene.xml
echo '{"file": "./gamma.binary", "uri": "brdfs/two%20words.binary"}' >scene.json
echo 'asset inputs:file = @../brdfs/alpha.binary@' >scene.usda
echo 'asset inputs:file = @@@C:/brdfs/beta.binary.gz@@@' >triple.usda
echo '{"windows": "C:\\brdfs\\beta.BINARY"}' >windows.json
echo '{"a": "alpha", "b": "brdfs/beta.binary", "c": "gamma.png", "d": "/gamma/"}' >mixed.json
echo '{"a": "x.binary"}' >literal.json
for scene in scene.pbrt scene.xml scene.json scene.usda triple.usda windows.json mixed.json literal.json; do
	code brdfpack subset -q -o out.bpk --scene $scene all.bpk
	names out.bpk
done
echo '{"a": "alpha.binary", "b": "brdfs/bteta.binary", "c": "wood.png"}' >lacking.json
code brdfpack subset -q -o out.bpk --scene lacking.json all.bpk
names out.bpk
cp alpha.binary grün.binary && build -q -o green.bpk grün.binary beta.binary
printf '{"a": "gru\xcc\x88n", "b": "beta", "c": "br\xc3\xa4unlich"}' >decomposed.json
code brdfpack subset -q -o out.bpk --scene decomposed.json green.bpk
names out.bpk
echo '{"b": "brdfs/wood.binary"}' >none.json
rm out.bpk
code brdfpack subset -q -o out.bpk --scene none.json all.bpk
[ ! -e out.bpk ] && echo "nothing was written"
