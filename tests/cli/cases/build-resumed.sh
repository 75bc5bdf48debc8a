# A build that was killed or interrupted: --update goes on from its finished records, and makes the archive of one build.
needs_hooks
fixture alpha beta gamma
mkdir in out && mv *.binary in
build -q -o fresh.bpk in
cat >stop.py <<'END'
import glob, os, signal, subprocess, sys, time
number = int(sys.argv[1])
environment = dict(os.environ, BRDFPACK_TEST_SLEEP="1")
build = subprocess.Popen([os.environ["BRDFPACK"], "build", "--any-lattice", "-j1", "-o", "out/out.bpk"] + sys.argv[2:] + ["in"], env=environment)
def finished():
    journals = glob.glob("out/.brdfpack-*-journal")
    return max((os.path.getsize(journal) for journal in journals), default=0) > 1000
while not finished() and build.poll() is None:
    time.sleep(0.01)
build.send_signal(number)
print("exit", build.wait(timeout=30))
END
origins() { sed -n 's/.*"name": *"\([a-z]*\)".*"record": *"\([a-z]*\)".*/\1 \2/p'; }
echo "killed:"
python3 stop.py 9
build --update --json -o out/out.bpk in | origins
cmp fresh.bpk out/out.bpk && echo "as if built at once"
ls -A out
rm out/out.bpk
echo "interrupted, and its measured file replaced:"
python3 stop.py 15
cp in/beta.binary in/alpha.binary
build --update --json -o out/out.bpk in | origins
build -q -o fresh.bpk in
cmp fresh.bpk out/out.bpk && echo "as if built at once"
ls -A out
echo "without --update, or with other options, anew:"
python3 stop.py 9
build --json -o out/out.bpk in | origins
python3 stop.py 9
build --update --effort 4 --json -o other.bpk in | origins
build --update --effort 4 --json -o out/out.bpk in | origins
cmp other.bpk out/out.bpk && echo "as if built at once"
ls -A out
rm out/out.bpk
echo "shards:"
python3 stop.py 9 --shard 2/2
for k in 2 1; do build --update --json --shard $k/2 -o out/out.bpk in | origins; mv out/out.bpk $k.bpk; done
brdfpack merge -q --expect 2 -o out/out.bpk 1.bpk 2.bpk
cmp fresh.bpk out/out.bpk && echo "as if built at once"
echo "a full disk:"
rm out/out.bpk
(
	ulimit -f 3 # blocks of 1024 bytes: a record or two
	trap '' XFSZ
	code build -j1 --budget 1500 -o out/out.bpk in
)
build --update --budget 1500 --json -o out/out.bpk in | origins | sort | uniq -c | sort | sed 's/^ *//'
ls -A out
