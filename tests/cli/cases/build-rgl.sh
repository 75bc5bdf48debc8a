# A folder of everything: a MERL-like table, tensor files whatever they are called, the text of a licence, a picture. The materials are packed,
# the rest is told in one line, and the same comes from tar, compressed tar and zip.
fixture alpha
python3 "$TESTS/tensor_files.py" .
mkdir -p all/deep && mv alpha.binary rough.bsdf spectral.bsdf all && mv glossy.bsdf all/deep/glossy.tensor
echo "made up; do what you like" >all/LICENSE-example.txt
printf '\x89PNG\r\n\x1a\n' >all/picture.png
build -o folder.bpk all
brdfpack list folder.bpk | cut -d ' ' -f 1
brdfpack list folder.bpk rough spectral | grep -A 3 source | grep -v SHA-256
brdfpack list --json folder.bpk | python3 -c '
import json, sys
for line in sys.stdin:
    material = json.loads(line)
    source = material.get("source", {})
    reciprocity = source.get("non_reciprocity")
    if reciprocity:
        assert 0 < reciprocity["median"] < reciprocity["percentile_95"] < 2 and reciprocity["cells"] > 900000, reciprocity
    print({k: v for k, v in source.items() if k not in ("sha256", "non_reciprocity")})'
mv all/deep/glossy.tensor all/deep/glossy.bsdf
tar cf a.tar all && build -o tar.bpk a.tar
tar czf a.tar.gz all && build -q -o targz.bpk a.tar.gz
python3 -m zipfile -c a.zip all && build -q -o zip.bpk a.zip
gzip -c all/rough.bsdf >rough.bsdf.gz && brdfpack build -o one.bpk rough.bsdf.gz && brdfpack list one.bpk | cut -d ' ' -f 1
for file in tar targz zip; do cmp folder.bpk $file.bpk && echo $file; done
brdfpack verify --deep folder.bpk
build -q --json -o again.bpk all | tail -n 1 | grep -o '"ignored_files.*texts": \[[^]]*\]'
# an extracted table carries its record, and that what it was made from
brdfpack extract -C out folder.bpk rough && brdfpack build -o kept.bpk out/rough.binary && brdfpack list kept.bpk rough | grep -c "RGL tensor file"
