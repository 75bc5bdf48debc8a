# The archive does not depend on the number of workers.
fixture alpha beta gamma zero constant spark
tar czf all.tar.gz ./*.binary
for jobs in 1 2 3 8; do
	build -j $jobs -o $jobs.bpk ./*.binary
	build -j$jobs -o stream-$jobs.bpk all.tar.gz
	cmp 1.bpk $jobs.bpk && cmp 1.bpk stream-$jobs.bpk && echo "same with $jobs"
done
