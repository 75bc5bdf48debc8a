# Files that are no archive: said so, exit 1, for every command.
fixture alpha
: >empty.bpk
printf 'hello, this is text and long enough to hold a header, one would think, would one not?' >text.bpk
printf '\211PNG\r\n' >picture.png
code brdfpack list picture.png
for file in empty.bpk text.bpk alpha.binary . missing.bpk /dev/null; do
	code brdfpack list $file
	code brdfpack verify $file
	code brdfpack extract -C x $file
done
ls
