# One file of MERL's own size, without --any-lattice: packed, and extracted at 34,992,012 bytes.
python3 - <<'END'
import array, struct
cells = 90 * 90 * 180
plane = array.array("d")
for i in range(90):
    level = 1500 * (0.1 + 10 / (1 + i * i))
    plane.extend(array.array("d", [level]) * (90 * 180))
with open("full.binary", "wb") as file:
    file.write(struct.pack("<3i", 90, 90, 180))
    for c in range(3):
        plane.tofile(file)
END
code brdfpack build -o out.bpk full.binary
brdfpack list --json out.bpk full | python3 -c 'import json, sys; d = json.loads(sys.stdin.readline()); print(d["bytes"] <= 60400, d["source"]["bytes"])'
code brdfpack extract -C x out.bpk
stat -c %s x/full.binary
