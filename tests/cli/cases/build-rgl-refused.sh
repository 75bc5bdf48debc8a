# Files that end in .bsdf and are no isotropic material of the RGL database, or a damaged one: each is refused by what it is, or by the field.
python3 "$TESTS/tensor_files.py" .
code brdfpack build -o out.bpk .
brdfpack list out.bpk | cut -d ' ' -f 1
rm rough.bsdf spectral.bsdf glossy.bsdf
tar czf bad.tar.gz *.bsdf
code brdfpack build -q -o none.bpk bad.tar.gz
ls *.bpk
