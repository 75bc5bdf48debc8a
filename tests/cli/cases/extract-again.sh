# What was extracted carries its record, and building from it gives the same archive again; --plain leaves the record out.
brdfpack synth --lattice 24x20x36 all
mkdir in && mv all/terracotta.binary all/wine-velvet.binary in
kept() { tail -n 1 | grep -o '"kept": [0-9]*'; }
for profile in paper spectral; do
	cp -r in 0
	for n in 1 2 3; do
		build --profile $profile --budget 9000 --json -o $n.bpk $((n - 1)) | kept
		brdfpack extract -C $n $n.bpk
	done
	cmp 1.bpk 3.bpk && echo "$profile: the same archive"
	# Without the record, or with another value in one cell of terracotta: fitted like a measurement.
	brdfpack extract --plain -C plain 1.bpk
	build --profile $profile --budget 9000 --json -o plain.bpk plain | kept
	printf '\0\0\0\0\0\0\360\077' | dd of=1/terracotta.binary bs=1 seek=12 conv=notrunc status=none
	build --profile $profile --budget 9000 --json -o changed.bpk 1 | sed 's/.*"name": \("[a-z-]*"\).*"record": \("[a-z]*"\).*/\1 \2/; s/.*\("kept": [0-9]*\).*/\1/'
	rm -r 0 1 2 3 plain
done
code brdfpack extract --plain --format json -C x 1.bpk 2>&1 | head -n 1
