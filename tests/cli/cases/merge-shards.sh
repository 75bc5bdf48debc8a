# merge --expect N knows by the names which archive is which shard: one of another division would leave materials out in silence.
fixture alpha beta
for n in a b c d e f g h i j; do cp alpha.binary $n.binary; done
for n in 2 3 4; do for k in $(seq $n); do build -q --shard $k/$n -o s-$n-$k.bpk *.binary; done; done
code brdfpack merge --expect 2 -o out.bpk s-3-1.bpk s-3-2.bpk
code brdfpack merge --expect 3 -o out.bpk s-4-1.bpk s-4-2.bpk s-4-3.bpk
code brdfpack merge --expect 3 --replace -o out.bpk s-3-1.bpk s-3-2.bpk s-3-2.bpk
code brdfpack merge --expect 1 -o out.bpk s-2-1.bpk
[ ! -e out.bpk ] || echo "one shard of one may hold any name"
