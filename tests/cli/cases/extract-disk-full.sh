# No room for an extracted file: an error, and no partial file.
fixture alpha
build -o out.bpk .
mkdir x
(
	ulimit -f 2
	trap '' XFSZ
	code brdfpack extract -C x out.bpk
)
ls -A x
