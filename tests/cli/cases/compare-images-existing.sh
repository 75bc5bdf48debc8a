# compare --images replaces pictures that brdfpack drew and no others: all of them are named, before anything is measured.
fixture alpha beta
build -q -o m.bpk .
code brdfpack compare --size 8 --images p m.bpk . >/dev/null
code brdfpack compare --size 8 --images p m.bpk . >/dev/null
echo precious >p/alpha-key.png
echo precious >p/beta-env.png
code brdfpack compare --size 8 --images p m.bpk .
code brdfpack compare --size 8 --light point --images p m.bpk . >/dev/null
cat p/alpha-key.png p/beta-env.png
code brdfpack compare --force --size 8 --images p m.bpk . >/dev/null
ls p
