#!/usr/bin/env bash
# The library, the tool and the unit tests that need no GSL, cross-compiled for ARM64 and run under qemu-user, and an archive built there
# compared with the one made here: tests/arm64.sh BUILD. Exit code 77: what that takes is not there.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
native=$1
build=build/arm64
for program in aarch64-linux-gnu-gcc qemu-aarch64; do
	command -v $program >/dev/null || { echo "skip: no $program (scripts/setup.sh arm64)"; exit 77; }
done
make=(make -s "-j$(nproc)" "BUILD=$build" CC=aarch64-linux-gnu-gcc AR=aarch64-linux-gnu-ar LD=aarch64-linux-gnu-ld
	OBJCOPY=aarch64-linux-gnu-objcopy CFLAGS="-O2 -Werror" TEST_LIBS=-lcmocka)
mapfile -t tests < <(grep -L 'gsl/\|robust_oracle\|sampling\.h' tests/test_*.c | grep -v 'tests/test_bench' | sed "s|^tests/\(.*\)\.c$|$build/tests/\1|")
"${make[@]}" "$build/brdfpack" "${tests[@]}" || exit 1
export QEMU_LD_PREFIX=/usr/aarch64-linux-gnu QEMU_SET_ENV=LD_LIBRARY_PATH=/usr/lib/aarch64-linux-gnu
failed=0
for test in "${tests[@]}"; do
	case $test in */test_workers | */test_source) continue ;; esac # forks and memory files of qemu itself
	timeout 600 qemu-aarch64 "$test" >"$build/log" 2>&1 || { echo "FAILED: $test"; tail -n 5 "$build/log"; failed=$((failed + 1)); }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$native/brdfpack" synth --lattice 24x20x36 "$scratch/in" || exit 1
for profile in paper spectral; do
	"$native/brdfpack" build -q -j1 --any-lattice --profile $profile -o "$scratch/here.bpk" "$scratch/in" || exit 1
	qemu-aarch64 "$build/brdfpack" build -q -j1 --any-lattice --profile $profile -o "$scratch/there.bpk" "$scratch/in" || exit 1
	cmp "$scratch/here.bpk" "$scratch/there.bpk" || { echo "$profile: another archive"; failed=$((failed + 1)); }
done
echo "${#tests[@]} test programs, $failed failed"
[ "$failed" = 0 ]
