#!/usr/bin/env bash
# Built with link-time optimisation, as distributions do, the static and the shared library export nothing but bp_ names, and a
# program links them with and without it: tests/lto.sh SCRATCH
set -euo pipefail
cd "$(dirname "$0")/.."
for compiler in gcc clang; do
	command -v "$compiler" >/dev/null || { echo "no $compiler here: left out"; continue; }
	build=$1/$compiler
	make -s -j"$(nproc)" BUILD="$build" CC="$compiler" CFLAGS="-O1 -flto" check-symbols
	for flags in "" -flto; do
		# shellcheck disable=SC2086
		"$compiler" -std=c17 -O1 $flags -Isrc -o "$build/consumer" tests/consumer.c "$build/libbrdfpack.a" -lz -lm
	done
	"$build/brdfpack" --version
done
