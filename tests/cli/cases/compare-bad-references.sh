# A material without a measured file, other extents, no valid cell, a damaged file: each is named, the others are compared.
fixture alpha beta gamma
build -q -o out.bpk .
mkdir measured && cp alpha.binary measured
code brdfpack compare --size 16 --light key out.bpk measured | sed 's/  *[0-9].*//'
cp "$FIXTURES/unmeasured.binary" measured/beta.binary
cp "$FIXTURES/truncated.binary" measured/gamma.binary
code brdfpack compare --size 16 --light key out.bpk measured | sed 's/  *[0-9].*//'
rm measured/alpha.binary
code brdfpack compare --size 16 --light key out.bpk measured alpha
python3 - <<'END'
import struct
with open("measured/alpha.binary", "wb") as file:
    file.write(struct.pack("<3i", 5, 6, 8) + struct.pack("<720d", *[100.0] * 720))
END
code brdfpack compare --size 16 --light key out.bpk measured alpha
code brdfpack compare --size 16 out.bpk nowhere
code brdfpack compare --size 16 out.bpk measured alpah
