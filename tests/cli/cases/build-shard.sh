# Disjoint parts by the names alone: any number of shards, in files, folders and streams, merges to the archive of one build.
fixture alpha beta gamma
for n in a b c d e f g h i j; do mv alpha.binary $n.binary 2>/dev/null || cp beta.binary $n.binary; done; mv gamma.binary k.binary; rm beta.binary
build -o all.bpk .
for n in 1 2 3 7; do
	for k in $(seq $n); do build --shard $k/$n -o s-$n-$k.bpk .; done
	brdfpack merge -q --expect $n -o merged.bpk s-$n-*.bpk
	cmp all.bpk merged.bpk && echo "$n shards: the same archive"
done
tar cf all.tar *.binary
for k in 1 2; do build --shard $k/2 -o t-$k.bpk all.tar; done
rm all.tar
brdfpack merge -q --expect 2 -o merged.bpk t-1.bpk t-2.bpk
cmp all.bpk merged.bpk && echo "from a tar: the same archive"
# More shards than materials: some are empty, and still archives.
for k in $(seq 40); do build -q --shard $k/40 -o many-$k.bpk .; done
brdfpack merge -q --expect 40 -o merged.bpk many-*.bpk
cmp all.bpk merged.bpk && echo "40 shards: the same archive"
printf 'a\nb\nc\nnot-there\n' >list
for k in 1 2; do build --shard $k/2 --manifest list -o m-$k.bpk . 2>&1 | grep -c 'not-there.*not among'; done | sort | tr '\n' ' '
echo "times told missing"
# What is no shard.
for s in 0/4 5/4 1/0 1 /3 -1/3 1/3x 1/70000; do code brdfpack build --shard $s -o out.bpk .; done
# What does not belong together.
code brdfpack merge --expect 3 -o out.bpk s-2-1.bpk s-2-2.bpk
code brdfpack merge --expect 2 -o out.bpk s-2-1.bpk s-2-1.bpk
build --budget 2000 --shard 2/2 -o other.bpk .
code brdfpack merge --expect 2 -o out.bpk s-2-1.bpk other.bpk
build --profile paper --shard 2/2 -o other.bpk .
code brdfpack merge --expect 2 -o out.bpk s-2-1.bpk other.bpk
code brdfpack merge -q -o mixed.bpk s-2-1.bpk other.bpk # without --expect they are any archives
[ ! -e out.bpk ] && echo "nothing was written"
