# A header that promises a hundred million materials: no page can hold them. An index that breaks off: one message.
fixture alpha beta gamma
build -o good.bpk .
python3 - <<'PY'
import struct, zlib
def header(count, source, target):
    data = bytearray(open(source, "rb").read())
    struct.pack_into("<Q", data, 24, count)
    struct.pack_into("<I", data, 60, zlib.crc32(bytes(data[:60])))
    open(target, "wb").write(data)
header(100000000, "good.bpk", "promises.bpk")
header(200, "good.bpk", "more.bpk")
PY
for command in list extract verify; do
	code brdfpack $command promises.bpk
	code brdfpack $command $([ $command = extract ] && echo -C x) more.bpk 2>&1 | sed 's/offset [0-9]*/offset N/' | cut -c1-150 | grep -v ' spectral ' | tail -n 4
done
