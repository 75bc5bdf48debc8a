# What records tell of their errors is measured again: confirmed, not judged where the file is another one, refused where it is wrong.
fixture alpha beta
mkdir measured others
mv *.binary measured
build -q --profile paper -o out.bpk measured
confirmed() { brdfpack compare --light point --size 16 "$1" "$2" | tail -n 1; }
confirmed out.bpk measured
cp measured/alpha.binary others/beta.binary
cp measured/alpha.binary others/alpha.binary
confirmed out.bpk others
# The first record's first layer, its log RMSE larger by a millionth, under right checksums.
python3 - <<'END'
import struct, zlib
archive = bytearray(open("out.bpk", "rb").read())
at, layer = 64, 64 + 208
head_bytes, = struct.unpack_from("<I", archive, at + 8)
place = layer + 8
struct.pack_into("<d", archive, place, struct.unpack_from("<d", archive, place)[0] * (1 + 1e-6))
struct.pack_into("<I", archive, at + head_bytes - 4, zlib.crc32(archive[at:at + head_bytes - 4]))
open("lies.bpk", "wb").write(archive)
END
code brdfpack verify lies.bpk
code brdfpack compare --light point --size 16 lies.bpk measured 2>&1 | sed 's/[0-9]\.[0-9e.-]*[0-9]/N/g' | grep -E 'alpha|exit|confirmed'
