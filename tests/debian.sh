#!/usr/bin/env bash
# Debian packages of this tree, which lintian finds no error in: tests/debian.sh. Ends with 77 where the tools are missing.
set -euo pipefail
cd "$(dirname "$0")/.."
for command in dpkg-buildpackage dh lintian; do command -v $command >/dev/null || { echo "skip: no $command (scripts/setup.sh debian)"; exit 77; }; done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
scripts/debian_package.sh "$scratch" >"$scratch/log" 2>&1 || { tail -n 30 "$scratch/log"; exit 1; }
lintian --allow-root --fail-on error "$scratch"/*.deb
version=$(sed -n 's/^#define BP_VERSION "\(.*\)"/\1/p' src/brdfpack.h)
for package in brdfpack libbrdfpack0 libbrdfpack-dev; do
	[ "$(dpkg-deb -f "$scratch/${package}_${version}"_*.deb Package Version | tr '\n' ' ')" = "Package: $package Version: $version " ]
done
# what is in the packages works
for package in "$scratch"/*.deb; do dpkg-deb -x "$package" "$scratch/root"; done
[ "$("$scratch/root/usr/bin/brdfpack" --version)" = "brdfpack $version" ]
cc -I"$scratch/root/usr/include" -o "$scratch/consumer" tests/consumer.c "$scratch"/root/usr/lib/*/libbrdfpack.a -lz -lm
"$scratch/root/usr/bin/brdfpack" synth --lattice 6x6x8 "$scratch/materials"
"$scratch/root/usr/bin/brdfpack" build -q --any-lattice -o "$scratch/demo.bpk" "$scratch/materials"
[ "$("$scratch/consumer" "$scratch/demo.bpk")" = "$(find "$scratch/materials" -name '*.binary' | wc -l)" ]
