# What replaces a file has its mode, and its owner where that is allowed; links are followed; by all commands alike.
fixture alpha
build -q -o a.bpk alpha.binary
umask 022
mkdir real
try() { # file command...
	local file=$1 mode
	shift
	for mode in 600 640 444; do
		"$@" >/dev/null 2>&1
		chmod $mode "real/$file"
		[ "$(id -u)" != 0 ] || chown 65534:12345 "real/$file"
		ln -sf "real/$file" "$file"
		"$@" >/dev/null || echo "$*: failed"
		[ -L "$file" ] || echo "$*: the link is gone"
		[ "$(stat -c %a "real/$file")" = $mode ] || echo "$*: mode $(stat -c %a "real/$file"), it was $mode"
		[ "$(id -u)" != 0 ] || [ "$(stat -c %u:%g "real/$file")" = 65534:12345 ] || echo "$*: owner $(stat -c %u:%g "real/$file")"
		rm -f "$file" "real/$file"
	done
}
at() { [ -L "$1" ] && echo "$1" || echo "real/$1"; }
try build.bpk eval 'build -q -o $(at build.bpk) alpha.binary'
try merge.bpk eval 'brdfpack merge -o $(at merge.bpk) a.bpk'
try subset.bpk eval 'brdfpack subset -o $(at subset.bpk) a.bpk'
try recover.bpk eval 'brdfpack recover -o $(at recover.bpk) a.bpk'
try render.png eval 'brdfpack render --size 8 -o $(at render.png) a.bpk alpha'
try show.svg eval 'brdfpack show -o $(at show.svg) a.bpk alpha'
try alpha.json eval 'brdfpack extract --force --format json -C $(dirname $(at alpha.json)) a.bpk'
ls -A real
build -q -o real/new.bpk alpha.binary
stat -c %a real/new.bpk
echo done
