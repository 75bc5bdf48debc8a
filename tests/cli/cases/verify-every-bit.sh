# Truncated at many bytes, and many single bits flipped: verify finds each, and nothing crashes.
fixture alpha
build -o out.bpk .
cat >damage.py <<'END'
import os, subprocess
tool = os.environ["BRDFPACK"]
data = open("out.bpk", "rb").read()
def run(name, bytes_):
    open("bad.bpk", "wb").write(bytes_)
    codes = [subprocess.run([tool, "verify", "bad.bpk"], capture_output=True).returncode,
             subprocess.run([tool, "list", "bad.bpk"], capture_output=True).returncode,
             subprocess.run([tool, "extract", "-C", "x", "bad.bpk"], capture_output=True).returncode]
    if codes[0] != 1 or any(code not in (0, 1) for code in codes):
        print(name, codes)
step = max(1, len(data) // 60)
for cut in range(0, len(data), step):
    run("cut at %d" % cut, data[:cut])
for at in range(0, len(data), step):
    bit = 1 << (at % 8)
    run("bit %d of byte %d" % (at % 8, at), data[:at] + bytes([data[at] ^ bit]) + data[at + 1:])
run("one byte more", data + b"x")
print("done")
END
python3 damage.py
