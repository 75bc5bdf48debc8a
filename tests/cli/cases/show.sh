# The pictures of the model, from an archive alone, with the measured file, and from a measured file.
fixture alpha
build -q --profile paper -o out.bpk .
brdfpack show -o a.svg out.bpk alpha
grep -c '<image' a.svg
grep -o 'before coding[^<]*' a.svg
brdfpack show --measured . -o b.svg out.bpk alpha
grep -c '<image' b.svg
grep -o 'before coding[^<]*' b.svg
brdfpack show --theta-h 0,45.5,90 -o c.svg alpha.binary
grep -c '<image' c.svg
grep -o 'theta_h [0-9][^<]*' c.svg | sort -u
brdfpack show -o d.png alpha.binary "another name"
head -c 4 d.png | tail -c 3
echo
# of a measured file is drawn what `build` would pack
build -q --profile spectral -o spectral.bpk .
brdfpack show --measured . -o e.svg spectral.bpk alpha
brdfpack show --profile spectral -o f.svg alpha.binary
cmp e.svg f.svg && cmp b.svg <(brdfpack show -o g.svg alpha.binary; cat g.svg) && echo "as packed"
# another material's file under that name would give a picture of nothing
mkdir other
cp "$FIXTURES/beta.binary" other/alpha.binary
code brdfpack show --measured other -o h.svg out.bpk alpha
# a folder's file of the RGL database is found as well
python3 "$TESTS/tensor_files.py" .
build -q -o rough.bpk rough.bsdf
brdfpack show --measured . -o h.svg rough.bpk rough && brdfpack show --measured rough.bsdf -o i.svg rough.bpk rough && cmp h.svg i.svg && echo "found"
