# Names that are not UTF-8 are shown escaped and refused, with the way out, the others are packed; --charset tells what they are.
fixture alpha
python3 - <<'END'
import io, tarfile, zipfile
data = open("alpha.binary", "rb").read()
class Plain(zipfile.ZipInfo):
    def _encodeFilenameFlags(self):
        return self.filename.encode(self.charset), self.flag_bits & ~0x800
for charset, odd in ("cp437", "grün"), ("shift_jis", "材質"), ("iso-8859-1", "grün"):
    names = ["d/one.binary", "d/%s.binary" % odd, "d/two.binary"]
    for suffix, mode in ("tar", "w"), ("tar.gz", "w:gz"):
        with tarfile.open(charset + "." + suffix, mode, format=tarfile.GNU_FORMAT, encoding=charset) as file:
            for name in names:
                info = tarfile.TarInfo(name)
                info.size = len(data)
                file.addfile(info, io.BytesIO(data))
    with zipfile.ZipFile(charset + ".zip", "w") as file:
        for name in names:
            info = Plain(name)
            info.charset = charset
            file.writestr(info, data)
END
for charset in cp437 shift_jis iso-8859-1; do
	for suffix in tar tar.gz zip; do
		code build -o out.bpk $charset.$suffix
		code build --charset $charset -o all.bpk $charset.$suffix
		brdfpack list out.bpk | sed '1d;$d;s/   .*//' | tr '\n' ' '
		brdfpack list all.bpk | sed '1d;$d;s/   .*//' | tr '\n' ' '
		echo
	done
done
code build --charset klingon -o out.bpk cp437.zip
code build --json -o json.bpk cp437.zip 2>/dev/null | grep -o '^{"name": "[^"]*", "path": "[^"]*", "error": "[^;]*'
# UTF-8 that says so needs no charset, and is not spoilt by one
mkdir u && cp alpha.binary u/grün.binary && tar cf u.tar --format=pax u
build -q -o u.bpk --charset cp437 u.tar && brdfpack list u.bpk | sed -n '2s/   .*//p'
