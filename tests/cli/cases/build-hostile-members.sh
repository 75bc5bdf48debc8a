# Members with '..' or an absolute path give only their stem; nothing is written outside.
fixture alpha beta
mkdir -p a/b
python3 - <<'END'
import tarfile, zipfile
with tarfile.open("a/b/x.tar.gz", "w:gz") as tar:
    for path, name in (("alpha.binary", "../../alpha.binary"), ("beta.binary", "/etc/beta.binary")):
        info = tar.gettarinfo(path)
        info.name = name
        tar.addfile(info, open(path, "rb"))
with zipfile.ZipFile("a/b/x.zip", "w", zipfile.ZIP_DEFLATED) as file:
    file.write("alpha.binary", "../../alpha.binary")
    file.write("beta.binary", "/beta.binary")
END
rm ./*.binary
code build -o tar.bpk a/b/x.tar.gz
code build -o zip.bpk a/b/x.zip
brdfpack list zip.bpk | cut -d ' ' -f 1
find . -type f | sort
