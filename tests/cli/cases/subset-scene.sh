# Materials whose name stands between quotes in pbrt, Mitsuba XML, USD or JSON; other words and odd quotes do no harm.
fixture alpha beta gamma
build -o all.bpk .
cat >scene.pbrt <<'END'
# don't stumble over this apostrophe, nor over "an open quote
Material "measured" "string filename" [ "alpha" ]
END
printf '<bsdf type="measured"><string name="material" value='"'beta'"'/></bsdf>' >scene.xml
printf 'def Material "gamma" { asset info:id = @x@ }\n' >scene.usda
printf '{"materials":["beta",\n"gamma"]}' >scene.json
printf '{"material":"alphabet","other":" beta "}\n' >none.json
names() { brdfpack list --json "$1" | sed -n 's/.*"name": *"\([^"]*\)".*/\1/p' | tr '\n' ' '; echo; }
for scene in scene.pbrt scene.xml scene.usda scene.json; do
	brdfpack subset -q -o out.bpk --scene "$scene" all.bpk
	names out.bpk
done
brdfpack subset -q -o out.bpk --scene scene.pbrt --scene scene.usda all.bpk alpha
names out.bpk
rm out.bpk
code brdfpack subset -o out.bpk --scene none.json all.bpk
code brdfpack subset -o out.bpk --scene missing.json all.bpk
mkfifo fifo
code brdfpack subset -o out.bpk --scene fifo all.bpk
head -c 100000 /dev/urandom >noise
code brdfpack subset -o out.bpk --scene noise all.bpk
[ ! -e out.bpk ] && echo "nothing was written"
