#!/usr/bin/env bash
# Do decoded values depend on the compiler? tests/stress_builds.sh BUILD: packs and decodes the stress materials in several
# builds, each in BUILD/NAME, and compares all decoded values with those of gcc -O3. Fails where they differ by more than 1e-5.
# On request only, no job of scripts/test.sh: compiling all of them takes minutes.
set -euo pipefail
build=$1
cd "$(dirname "$0")/.."
failed=0
variant() {
	local name=$1
	shift
	make -s -j"$(nproc)" BUILD="$build/$name" "$@" "$build/$name/tests/stress" >/dev/null
	if [ "$name" = gcc-O3 ]; then
		"$build/$name/tests/stress" -d "$build/stress-values"
	else
		printf '%s against gcc -O3: ' "$name"
		"$build/$name/tests/stress" -c "$build/stress-values" || failed=1
	fi
}
variant gcc-O3 CC=gcc CFLAGS=-O3
variant gcc-O3-without-avx2 CC=gcc CFLAGS="-O3 -DBRDFPACK_PLAIN_KERNELS"
variant gcc-O2 CC=gcc CFLAGS=-O2
variant gcc-O0 CC=gcc CFLAGS=-O0
variant clang-O3 CC=clang CFLAGS=-O3
variant clang-O3-without-avx2 CC=clang CFLAGS="-O3 -DBRDFPACK_PLAIN_KERNELS"
variant clang-O2 CC=clang CFLAGS=-O2
variant clang-O0 CC=clang CFLAGS=-O0
rm -f "$build/stress-values"
exit $failed
