# All zero, constant, one bright cell, 1e-300, 1e300: packed, and extracted finite and not negative.
fixture zero constant spark faint huge
code build -q -o out.bpk .
brdfpack extract -C x out.bpk
python3 - <<'END'
import glob, math, struct
for path in sorted(glob.glob("x/*.binary")):
    data = open(path, "rb").read()
    values = struct.unpack("<%dd" % ((len(data) - 12) // 8), data[12:])
    fine = all(math.isfinite(v) and (v >= 0 or -1.0625 < v <= -1) for v in values)
    print(path, len(data), "fine" if fine else "NOT FINITE OR NEGATIVE")
END
