# Links and devices in a tar hold no table: each is named with the way out, in --json too; the others are packed, exit 1.
fixture alpha beta
mkdir m && mv beta.binary m && ln m/beta.binary m/hard.binary && ln -s ../alpha.binary m/soft.binary && mkfifo m/fifo.binary
ln -s nowhere m/readme.txt
tar cf links.tar --sort=name m alpha.binary
gzip -k links.tar
code build -o tar.bpk links.tar
code build -o targz.bpk links.tar.gz
cmp tar.bpk targz.bpk
brdfpack list tar.bpk | cut -d ' ' -f 1
code build --strict -o strict.bpk links.tar
code build --strict -q -o strict.bpk links.tar.gz 2>/dev/null
[ ! -e strict.bpk ] && echo "nothing was written"
code build --json -o json.bpk links.tar.gz 2>/dev/null | grep -o '^{"name": "[a-z]*", "path": "[^"]*", "error": "[^;]*\|"refused": [0-9]*'
# what a manifest leaves out is no loss
printf 'alpha\nbeta\n' >list
code build -o listed.bpk --manifest list links.tar.gz
# links of a folder are files there
rm m/fifo.binary
build -q -o folder.bpk m && brdfpack list folder.bpk | cut -d ' ' -f 1
python3 - <<'END'
import stat, zipfile
with zipfile.ZipFile("links.zip", "w") as file:
    file.write("alpha.binary")
    link = zipfile.ZipInfo("soft.binary")
    link.create_system, link.external_attr = 3, (stat.S_IFLNK | 0o777) << 16
    file.writestr(link, "alpha.binary")
END
code build -o zip.bpk links.zip
