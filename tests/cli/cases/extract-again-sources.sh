# Extracted files in a tar, compressed, in a zip; one or two workers; --update; another name (no longer: the budget may be full), profile or budget; a manifest of the measured files.
brdfpack synth --lattice 24x20x36 all
mkdir in && mv all/terracotta.binary all/wine-velvet.binary in
kept() { tail -n 1 | grep -o '"materials": [0-9]*, "reused": [0-9]*, "kept": [0-9]*, "refused": [0-9]*'; }
again() { build --budget 9000 --json -o again.bpk "$@" | kept; }
same() { cmp out.bpk again.bpk && echo "the same archive"; }
build -q --budget 9000 -o out.bpk in
brdfpack extract -C x out.bpk
tar -cf x.tar x && tar -czf x.tgz x && python3 -m zipfile -c x.zip x/*
for from in x.tar x.tgz x.zip "-j1 x" "-j2 x/wine-velvet.binary x/terracotta.binary"; do
	again $from && same
done
again --update x && same
build -q --budget 9000 -o again.bpk in
again --update x && same
again --update in && same
mkdir y && cp x/terracotta.binary y/other-name.binary
again y
brdfpack list again.bpk | sed -n 's/ *[0-9.]* *spectral.*//p'
cmp <(brdfpack extract -C z --plain again.bpk && cat z/other-name.binary) <(brdfpack extract -C z --plain out.bpk && cat z/terracotta.binary) && echo "the same values"
again --budget 8000 x
build --max-error 0.01 --json -o again.bpk x | kept
build --profile paper --json -o paper.bpk x | kept
(cd in && for file in *; do printf '%s\t%s\t%s\n' "${file%.binary}" "$(stat -c %s "$file")" "$(sha256sum "$file" | cut -d ' ' -f 1)"; done) >list.tsv
again --manifest list.tsv x
