# A sphere from an archive and from a measured file, as PNG and as PFM.
fixture alpha
build -q -o out.bpk .
brdfpack render -o a.png out.bpk alpha
head -c 4 a.png | tail -c 3
echo
brdfpack render --light env --size 12 -o a.pfm alpha.binary
head -n 3 a.pfm
stat -c %s a.pfm
brdfpack render --light point --size 1 -o b.pfm out.bpk alpha
stat -c %s b.pfm
ls
