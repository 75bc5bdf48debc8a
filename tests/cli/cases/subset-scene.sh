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
# names within names, blanks, quotes and other alphabets, as they stand and as JSON and XML escape them
mkdir odd
for name in 'al' 'alpha-2' 'two words' 'grün' '𝛼' 'a "b" c' "o'neil" 'black & white' 'back\slash'; do cp alpha.binary "odd/$name.binary"; done
build -q -o odd.bpk odd
cat >plain.json <<'END'
{"a":"alpha-2","b":"two words","c":"grün","d":"𝛼"}
END
cat >escaped.json <<'END'
{"c":"gr\u00FCn","d":"\ud835\udefc","e":"a \"b\" c","g":"back\\slash","h":"\ud835","i":"C:\"}
END
cat >escaped.xml <<'END'
<string value="black &amp; white"/><string value="gr&#xfc;n"/><string value='a &quot;b&quot; c'/><string value="o&#39;neil"/>
<string value="&#55349;"/><string value="&#;"/><string value="&unknown;"/><string value="al&#x110000;"/>
END
for scene in plain.json escaped.json escaped.xml; do
	brdfpack subset -q -o out.bpk --scene "$scene" odd.bpk
	brdfpack list out.bpk | sed '1d;$d;s/   .*//'
done
printf '{"a":"alp", "b":"alpha-", "c":"\\u", "d":"\\u00", "e":"al\\n", "f":"\\", "g":"&#x", "h":"&"}' >none-odd.json
code brdfpack subset -o out-none.bpk --scene none-odd.json odd.bpk
rm out.bpk
code brdfpack subset -o out.bpk --scene none.json all.bpk
code brdfpack subset -o out.bpk --scene missing.json all.bpk
mkfifo fifo
code brdfpack subset -o out.bpk --scene fifo all.bpk
head -c 100000 /dev/urandom >noise
code brdfpack subset -o out.bpk --scene noise all.bpk
[ ! -e out.bpk ] && echo "nothing was written"
