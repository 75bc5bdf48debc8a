# The same materials give the same bytes, from a folder, in any order, from tar, compressed tar and zip. A file met twice is one.
fixture alpha beta gamma
mkdir -p folder/deep/deeper && mv alpha.binary folder && mv beta.binary folder/deep && mv gamma.binary folder/deep/deeper
build -o folder.bpk folder
build -o files.bpk folder/deep/deeper/gamma.binary folder/alpha.binary folder/deep
tar cf a.tar folder && build -o tar.bpk a.tar
tar czf a.tar.gz folder && build -o targz.bpk a.tar.gz
python3 -m zipfile -c a.zip folder && build -o zip.bpk a.zip
for file in files tar targz zip; do cmp folder.bpk $file.bpk && echo $file; done
