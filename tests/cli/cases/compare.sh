# One row per material in name order whatever the number of processes, then median, worst and mean.
fixture alpha beta gamma
build -q --profile paper -o out.bpk .
brdfpack compare --size 16 -j 1 out.bpk . >one
brdfpack compare --size 16 -j 3 out.bpk . >three
cmp one three && echo same
cut -c 1-8 one
brdfpack compare --size 16 --light key out.bpk . gamma alpha | cut -c 1-8
brdfpack compare --size 16 --json --light point out.bpk . beta | sed 's/: [0-9.e+-]*[0-9]/: N/g'

# two blocks, which 100 columns hold with names of 24
cp gamma.binary specular-violet-phenolic.binary
build -q -o long.bpk .
brdfpack compare --size 16 long.bpk . >long
awk 'length($0) > 100 {print "too wide: " $0}' long
grep -c '^specular-violet-phenolic' long
