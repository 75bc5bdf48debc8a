# What was extracted carries its record and is packed again without loss, generation after generation; --plain leaves it out.
brdfpack synth --lattice 24x20x36 all
mkdir in && mv all/terracotta.binary all/wine-velvet.binary in
kept() { tail -n 1 | grep -o '"kept": [0-9]*'; }
for profile in paper default; do
	cp -r in 0
	for n in 1 2 3; do
		build --profile $profile --budget 9000 --json -o $n.bpk $((n - 1)) | kept
		brdfpack extract -C $n $n.bpk
		brdfpack extract --plain -C plain-$n $n.bpk
	done
	cmp plain-1/terracotta.binary plain-3/terracotta.binary && cmp plain-1/wine-velvet.binary plain-3/wine-velvet.binary && echo "$profile: the same values"
	# Without the record, or with another value in one cell of terracotta: fitted like a measurement.
	build --profile $profile --budget 9000 --json -o plain.bpk plain-1 | kept
	printf '\0\0\0\0\0\0\360\077' | dd of=1/terracotta.binary bs=1 seek=12 conv=notrunc status=none
	build --profile $profile --budget 9000 --json -o changed.bpk 1 | kept
	rm -r 0 1 2 3 plain-*
done
code brdfpack extract --plain --format json -C x 1.bpk 2>&1 | head -n 1
