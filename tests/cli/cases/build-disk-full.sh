# No room for the output: an error that names it, nothing left behind, an older archive untouched.
fixture alpha beta gamma zero constant spark
mkdir out && build -o out/out.bpk alpha.binary && cp out/out.bpk before
(
	ulimit -f 1 # block of 1024 bytes
	trap '' XFSZ
	code build -o out/out.bpk .
)
cmp out/out.bpk before && echo untouched
ls -A out
