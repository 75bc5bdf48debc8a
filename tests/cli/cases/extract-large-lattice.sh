# A few hundred bytes of an archive can ask for a large table: it is written only when that is asked for.
python3 -c 'import struct; f = open("large.binary", "wb"); f.write(struct.pack("<3i", 144, 144, 144)); f.truncate(12 + 24 * 144 ** 3)'
build -q -o large.bpk large.binary
[ "$(stat -c %s large.bpk)" -lt 10000 ] && echo small
code brdfpack extract -C out large.bpk
ls out 2>/dev/null
code brdfpack extract --any-lattice -C out large.bpk
stat -c %s out/large.binary
