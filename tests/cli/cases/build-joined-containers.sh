# Tars that were joined are read to the last one, compressed ones too; of joined zips only the last can be, and that is told.
fixture alpha beta gamma
for name in alpha beta gamma; do tar cf $name.tar $name.binary; python3 -m zipfile -c $name.zip $name.binary; done
cat alpha.tar beta.tar gamma.tar >all.tar
gzip -c all.tar >all.tar.gz
for name in alpha beta gamma; do xz -c $name.tar; done >all.tar.xz
build -q -o folder.bpk ./*.binary
for file in all.tar all.tar.gz all.tar.xz; do code build -o out.bpk $file; cmp folder.bpk out.bpk; done
cat alpha.zip beta.zip >two.zip
code build -o zip.bpk two.zip
brdfpack list zip.bpk | cut -d ' ' -f 1
# what stands behind a compressed container is told too; zeros are no loss
(gzip -c alpha.tar; xz -c beta.tar) >mixed.tar.gz
(bzip2 -c alpha.tar; echo garbage) >garbage.tar.bz2
(gzip -c alpha.tar; head -c 5000 /dev/zero) >padded.tar.gz
(cat alpha.zip beta.tar) >behind.zip
for file in mixed.tar.gz garbage.tar.bz2 behind.zip; do code build -o odd.bpk $file; brdfpack list odd.bpk | sed '1d;$d;s/ .*//'; done
code build -o odd.bpk padded.tar.gz
(cat alpha.tar; echo something else) >odd.tar
code build -o odd.bpk odd.tar
brdfpack list odd.bpk | cut -d ' ' -f 1
