# What is 0 above the horizon was measured and stays black; a table that is black everywhere is no pattern.
brdfpack synth --clean --lattice 20x20x30 all >synth.out
fixture zero
python3 - <<'END'
import struct
with open("all/wall-paint.binary", "rb") as file:
    data = file.read()
cells = 20 * 20 * 30
values = [list(struct.unpack_from("<%dd" % cells, data, 12 + 8 * cells * c)) for c in range(3)]
for plane in values:
    for n in range(cells):
        plane[n] = max(plane[n], 0) if n < 14 * 600 else 0  # nothing beyond theta_h = 44 degrees
with open("half-black.binary", "wb") as file:
    file.write(data[:12] + b"".join(struct.pack("<%dd" % cells, *plane) for plane in values))
END
code build -o auto.bpk half-black.binary zero.binary
code build -o holes.bpk --zeros=holes half-black.binary zero.binary
for archive in auto holes; do
	brdfpack extract --plain -C $archive $archive.bpk half-black 2>&1
	python3 - $archive <<'END'
import struct, sys
with open(sys.argv[1] + "/half-black.binary", "rb") as file:
    data = file.read()
value = struct.unpack_from("<d", data, 12 + 8 * (15 + 30 * (0 + 20 * 17)))[0]
print(sys.argv[1], "black" if 0 <= value < 1e-2 else "filled" if value > 1 else value)
END
done
