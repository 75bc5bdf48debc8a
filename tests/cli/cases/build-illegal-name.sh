# An illegal name is refused and shown escaped, the others are packed.
fixture alpha beta
mv beta.binary $'be\nta.binary'
code build -o out.bpk .
mv $'be\nta.binary' $'be\xffta.binary'
code build -o out.bpk .
ls *.bpk 2>/dev/null
