#!/usr/bin/env bash
# The unit tests on ARM64: cross-compiled by Debian's gcc-12-aarch64-linux-gnu, run under qemu-user: tests/arm64.sh BUILD [TEST]...
# What compares with the GSL, and what takes minutes when every instruction is translated, is left out. Where the compiler, qemu or
# the ARM64 libraries are missing it says so and exits with 77; scripts/setup.sh arm64 installs them.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
shift
cross=aarch64-linux-gnu
compiler=$cross-gcc-12 # the package without a version is one that gcc-multilib excludes
for need in $compiler qemu-aarch64; do
	command -v "$need" >/dev/null || { echo "skip: $need is not installed (scripts/setup.sh arm64)"; exit 77; }
done
libraries="-lcmocka -larchive -lnettle -lpng -lz -lm"
# shellcheck disable=SC2086
if ! echo 'int main(void) { return 0; }' | $compiler -x c - -x none $libraries -o /dev/null 2>/dev/null; then
	echo "skip: libraries for ARM64 are not installed (scripts/setup.sh arm64)"
	exit 77
fi
tools=(CC=$compiler LD=$cross-ld AR=$cross-ar OBJCOPY=$cross-objcopy)
if [ $# = 0 ]; then
	set -- bytes carried compact_row cosines decoded direction environment fast_math fidelity fill holes hostile index items lattice \
		memory merl_file pack paper_sections range_coder reader record rgl_material select shown source spans spectrum spectrum_inverse table vectors \
		wavelet workers writer
fi
make -s -j"$(nproc)" BUILD="$build" "${tools[@]}" CFLAGS="-O2 -Werror" TEST_LIBS=-lcmocka "$build/libbrdfpack.a" "$build/brdfpack" "${@/#/$build/tests/test_}"
for name in "$@"; do
	echo "== $name"
	timeout 300 qemu-aarch64 "$build/tests/test_$name"
done
# and the tool: an archive made there has the bytes of one made here, and decodes to the same values
if [ -x "${NATIVE:-}" ]; then
	scratch=$(mktemp -d)
	trap 'rm -rf "$scratch"' EXIT
	"$NATIVE" synth --lattice 12x10x16 "$scratch/materials"
	for profile in paper spectral; do
		"$NATIVE" build -q --any-lattice --profile $profile -o "$scratch/here.bpk" "$scratch/materials"
		qemu-aarch64 "$build/brdfpack" build -q -j1 --any-lattice --profile $profile -o "$scratch/there.bpk" "$scratch/materials"
		cmp "$scratch/here.bpk" "$scratch/there.bpk"
		"$NATIVE" extract -C "$scratch/a" "$scratch/here.bpk"
		qemu-aarch64 "$build/brdfpack" extract -C "$scratch/b" "$scratch/here.bpk"
		diff -r "$scratch/a" "$scratch/b"
		rm -r "$scratch/a" "$scratch/b" "$scratch"/*.bpk
	done
	echo "the same archives and values as on this machine"
fi
