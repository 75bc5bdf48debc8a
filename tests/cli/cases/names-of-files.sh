# A material may be called by its measured file's name or path; another Unicode form of a name is recognised and suggested.
fixture alpha beta
cp alpha.binary 'grün.binary' && cp alpha.binary 'ガ.binary'
build -q -o m.bpk .
names() { brdfpack list --json "$1" | sed -n 's/.*"name": *"\([^"]*\)".*/\1/p' | tr '\n' ' '; echo; }
for written in alpha.binary ./beta.binary /data/merl/grün.BINARY alpha.binary.gz merl/beta; do
	brdfpack list --json m.bpk "$written" | sed -n 's/.*"name": *"\([^"]*\)".*/\1/p'
done
code brdfpack extract -C x m.bpk beta.binary && ls x
code brdfpack extract -C x m.bpk bteta.binary
code brdfpack list m.bpk $'gru\xcc\x88n'
code brdfpack list m.bpk $'カ\xe3\x82\x99.binary'
code brdfpack render --size 8 -o a.png m.bpk x/alpha.binary
rm -r x
ls -1 *.binary >list && code build -q -o listed.bpk --manifest list . && cmp m.bpk listed.bpk
find . -type f -name '[ab]*.binary' >list && code build -q -o listed.bpk --manifest list . && names listed.bpk
printf '\357\273\277alpha\r\nbeta.binary\r\n' >bom && code build -q -o listed.bpk --manifest bom . && names listed.bpk
printf '\357\273\277name\tbytes\nalpha.binary\t6924\n' >table && code build -q -o listed.bpk --manifest table . && names listed.bpk
printf 'alpha\ngru\xcc\x88n\n' >nfd && code build -q -o listed.bpk --manifest nfd . && names listed.bpk
printf 'alpha\nalpha.binary\n' >twice && code build -q -o listed.bpk --manifest twice .
printf '\377\376a\0' >wide && code build -q -o listed.bpk --manifest wide .
code build -q -o listed.bpk --json --manifest nfd . 2>/dev/null | grep -o '"error": "[^;]*'
