# No material at all: an error and no archive; also when an input does not exist.
mkdir folder && touch folder/readme.txt
code build -o out.bpk folder
code build -o out.bpk nowhere
tar cf empty.tar folder
code build -o out.bpk empty.tar
ls
