# Zeros, an empty file, a page of HTML, a part of a split zip: each is told for what it is, the others are packed, exit 1.
fixture alpha
head -c 30720 /dev/zero >zeros
: >nothing
printf '\n<!DOCTYPE html>\n<html><body>404</body></html>\n' >page
printf '\357\273\277<HTML>' >page2
echo '{"error": "no such file"}' >text
printf 'version https://git-lfs.github.com/spec/v1\noid sha256:0\n' >pointer
printf '7z\274\257\047\034\0\4' >seven
for suffix in zip tar tar.gz tar.zst binary.zst; do for kind in zeros nothing page page2 text pointer seven; do cp $kind $kind.$suffix; done; done
for kind in zeros nothing page page2 text pointer seven; do code build -q -o out.bpk alpha.binary $kind.zip $kind.tar $kind.tar.gz $kind.tar.zst $kind.binary.zst; done
python3 - <<'END'
import zipfile
open("noise.binary", "wb").write(bytes(range(250)) * 36)
with zipfile.ZipFile("whole.zip", "w") as file:
    file.write("noise.binary")
data = open("whole.zip", "rb").read()
end = data.rindex(b"PK\5\6")
open("last.zip", "wb").write(data[4000:end] + data[end:end + 4] + b"\1\0\1\0" + data[end + 8:])
open("first.z01", "wb").write(b"PK\7\10" + data[:4000])
END
mkdir parts && cp alpha.binary last.zip first.z01 parts
code build -o out.bpk parts
code build -o out.bpk parts/alpha.binary first.z01 2>&1 | grep -c 'a part of a split zip'
mkdir mixed && cp alpha.binary zeros.tar.zst mixed && touch mixed/readme.txt mixed/other.7z mixed/other.rar
code build -o out.bpk mixed
code build --json -o out.bpk mixed 2>/dev/null | grep -o '"path": "[^"]*", "error": "[^"]*"'
# an input that gives nothing
mkdir bare && touch bare/notes.txt
tar czf bare.tar.gz bare
code build -o out.bpk alpha.binary bare bare.tar.gz
code build -o out.bpk mixed/alpha.binary whole.zip
