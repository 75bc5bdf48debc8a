# The longest stem that a measured file can have is packed and extracted; somebody else's temporary files stay.
fixture alpha
for n in 230 237 240 248; do
	name=$(printf 'x%.0s' $(seq $n))
	mkdir $n && cp alpha.binary "$n/$name.binary"
	code build -q -o $n.bpk $n
	code brdfpack extract -C out-$n $n.bpk
	ls out-$n | wc -c
done
mkdir out && touch out/alpha.binary.tmp-1-0 out/alpha.binary.tmp-$$-0 out/.alpha.binary.1-0.partial out/.brdfpack-1
build -q -o out/a.bpk alpha.binary
code brdfpack extract -C out out/a.bpk
ls -A out | sed "s/$$/PID/"
