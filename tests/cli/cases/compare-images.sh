# Pictures of every lighting; a folder that cannot be made or written is told before anything else.
fixture alpha
build -q -o out.bpk .
brdfpack compare --size 16 --images pictures out.bpk . >plain
ls pictures
brdfpack compare --size 16 --light env --images env out.bpk . >/dev/null
ls env
code brdfpack compare --size 16 --images missing/pictures out.bpk .
code brdfpack compare --size 16 --images alpha.binary out.bpk .
mkdir nothing
code brdfpack compare --size 16 --images unused out.bpk nothing
[ ! -e unused ] || echo "an empty folder is left"
