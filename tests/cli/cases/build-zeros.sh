# Holes that were clamped at 0, or set to another constant, are found, told, recorded and shown; --zeros says what they are otherwise.
brdfpack synth --clean --lattice 20x20x30 all >synth.out
mkdir marked zero tiny red
for name in wall-paint silvered-mirror; do cp all/$name.binary marked; done
python3 - <<'END'
import struct
for name in "wall-paint", "silvered-mirror":
    with open("marked/%s.binary" % name, "rb") as file:
        data = file.read()
    cells = 20 * 20 * 30
    planes = [struct.unpack_from("<%dd" % cells, data, 12 + 8 * cells * c) for c in range(3)]
    for folder, change in (("zero", lambda v, c: max(v, 0)), ("tiny", lambda v, c: max(v, 1e-9)), ("red", lambda v, c: v if c == 0 else max(v, 0))):
        with open("%s/%s.binary" % (folder, name), "wb") as file:
            file.write(data[:12] + b"".join(struct.pack("<%dd" % cells, *(change(v, c) for v in planes[c])) for c in range(3)))
END
# but for the source's SHA-256, the word on holes and the head's checksum, the records are those of the marked files
same() {
	python3 - "$@" <<'END'
import sys
def plain(path):
    data, at, out = open(path, "rb").read(), 64, b""
    while data[at:at + 4] == b"\x8bREC":
        head, size = (int.from_bytes(data[at + n:at + n + 4], "little") for n in (8, 12))
        record = data[at:at + size]
        out, at = out + record[:52] + record[56:72] + record[104:head - 4] + record[head:], at + size
    return out
print("the same records" if plain(sys.argv[1]) == plain(sys.argv[2]) else "other records")
END
}
build -o marked.bpk marked
for folder in zero tiny red; do
	code build -o $folder.bpk $folder
	same $folder.bpk marked.bpk
done
tar czf zero.tar.gz zero && python3 -m zipfile -c zero.zip zero
for container in zero.tar.gz zero.zip; do build -q -o other.bpk $container && cmp other.bpk zero.bpk && echo $container; done
brdfpack list zero.bpk wall-paint | grep value
brdfpack list --json zero.bpk wall-paint | grep -o '"nonfinite_cells.*horizon\|"options.*"errors'
build --json -q -o other.bpk zero/wall-paint.binary | grep -o '"warnings.*]'
brdfpack compare --light=key zero.bpk zero | tail -n 1
for rule in measured holes maybe; do
	code build -o $rule.bpk --zeros=$rule zero
	[ ! -e $rule.bpk ] || brdfpack list $rule.bpk wall-paint | grep value
done
same measured.bpk marked.bpk
# a record of another rule is not taken over, nor is one shard merged with another of another rule
build -q --update --json -o measured.bpk zero | tail -n 1 | grep -o '"reused": [0-9]*'
build -q --update --json -o measured.bpk zero | tail -n 1 | grep -o '"reused": [0-9]*'
build -q --zeros=measured --shard 1/2 -o one.bpk zero
build -q --shard 2/2 -o two.bpk zero
code brdfpack merge --expect 2 -o both.bpk one.bpk two.bpk
