# Damage is named with its place; the other materials are still listed and extracted.
fixture alpha beta gamma
build -o out.bpk .
python3 - <<'END'
data = bytearray(open("out.bpk", "rb").read())
at = data.index(b"\x8bREC", data.index(b"beta")) - 3 # the end of beta's record
data[at] ^= 1
open("out.bpk", "wb").write(data)
END
code brdfpack verify out.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
code brdfpack extract -C x out.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
ls x
