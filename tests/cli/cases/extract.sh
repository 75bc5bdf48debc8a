# extract writes MERL files of the source's size; names select; -C creates folders.
fixture alpha beta
build -o out.bpk .
code brdfpack extract -C new/folder out.bpk
code brdfpack extract -C one out.bpk beta
cmp one/beta.binary new/folder/beta.binary && echo same
code brdfpack extract -C twice out.bpk beta beta.binary
brdfpack list --json out.bpk beta beta | wc -l
stat -c '%s %n' new/folder/* one/*
python3 - <<'END'
import struct
source = open("alpha.binary", "rb").read()
packed = open("new/folder/alpha.binary", "rb").read()
print("header", source[:12] == packed[:12], len(source) == len(packed))
read = lambda data: struct.unpack("<%dd" % ((len(data) - 12) // 8), data[12:])
print("finite, and negative only from -1.0625 to -1", all(p >= 0 or -1.0625 < p <= -1 for p in read(packed)))
END
