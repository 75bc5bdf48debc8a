# What is intact in a damaged archive is saved, even without header and index; what is lost is named.
fixture alpha beta gamma
build -o out.bpk . >/dev/null
brdfpack extract -C whole out.bpk
damage out.bpk hole.bpk beta
python3 - <<'PY'
data = bytearray(open("hole.bpk", "rb").read())
data[:64] = bytes(64)
open("headless.bpk", "wb").write(data[:data.index(b"\x8bIDX")])
PY
code brdfpack recover -o saved.bpk hole.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
code brdfpack recover -o again.bpk headless.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
cmp saved.bpk again.bpk
code brdfpack verify --deep saved.bpk
brdfpack extract -C saved saved.bpk
for name in alpha gamma; do cmp "whole/$name.binary" "saved/$name.binary"; done
code brdfpack recover -o hole.bpk hole.bpk
code brdfpack recover --force -o hole.bpk hole.bpk >/dev/null 2>&1
brdfpack verify hole.bpk
head -c 3000 out.bpk >cut.bpk
code brdfpack recover -o none.bpk cut.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
rm none.bpk
code brdfpack recover -o none.bpk whole
code brdfpack recover -o none.bpk whole/alpha.binary
code brdfpack recover hole.bpk
ls
