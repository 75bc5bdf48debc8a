#!/usr/bin/env bash
# A small build, list, extract and verify under valgrind, workers included: tests/valgrind.sh BUILD
set -euo pipefail
tool=$PWD/$1/brdfpack
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir in
python3 "$here/cli/fixtures.py" in
rm in/beta.binary in/gamma.binary # a few are enough
tar czf in.tar.gz in

# Leaks count in the parent; workers end by a signal while their tables are still theirs.
checked() {
	local wanted=$1 code=0
	shift
	valgrind -q --error-exitcode=99 --trace-children=yes --leak-check=full --errors-for-leak-kinds=definite "$tool" "$@" || code=$?
	if [ $code != "$wanted" ]; then
		echo "brdfpack $*: exit $code, expected $wanted"
		exit 1
	fi
}
checked 1 build -q --any-lattice -j2 -o out.bpk in
checked 1 build -q --any-lattice -j2 -o stream.bpk in.tar.gz
cmp out.bpk stream.bpk
checked 0 list out.bpk
checked 0 list --json out.bpk alpha
checked 1 list out.bpk alhpa
checked 0 extract -C x out.bpk
checked 0 extract --format json -C x out.bpk alpha
checked 0 verify --deep out.bpk
head -c 3000 out.bpk >cut.bpk
checked 1 verify cut.bpk
