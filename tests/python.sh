#!/usr/bin/env bash
# The independent Python reader against the C library, value by value: tests/python.sh BUILD
set -euo pipefail
tool=$PWD/$1/brdfpack
here=$(cd "$(dirname "$0")" && pwd)
reader=$here/../scripts/read_bpk.py
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
"$tool" synth --lattice 12x10x16 all
mkdir in # the reader is slow: four materials of very different kinds, and the small odd ones
for name in silvered-mirror mother-of-pearl wine-velvet terracotta; do mv all/$name.binary in; done
python3 "$here/cli/fixtures.py" in
rm in/truncated.binary in/trailing.binary in/header.binary in/extents.binary in/empty.binary in/unmeasured.binary
for profile in paper spectral; do
	"$tool" build -q --any-lattice --profile $profile -o $profile.bpk in
	"$tool" extract -C $profile $profile.bpk
	python3 "$reader" verify $profile.bpk
	python3 "$here/python_compare.py" "$reader" $profile.bpk $profile
done
