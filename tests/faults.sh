#!/usr/bin/env bash
# Faults survived: tests/faults.sh BUILD ASAN [--long]. BUILD holds brdfpack, and in tests/, tsan/tests/ and ASAN/tests/ what runs under faults.
set -euo pipefail
build=$PWD/$1
asan=$PWD/$2
long=${3:-}
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir few many
python3 - "$here" <<'END'
import importlib.util, sys
spec = importlib.util.spec_from_file_location("fixtures", sys.argv[1] + "/cli/fixtures.py")
fixtures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(fixtures)
for n in range(2):
    fixtures.write("few/m%d.binary" % n, fixtures.table(n + 1, (4, 4, 4)), (4, 4, 4))
for n in range(400):
    fixtures.write("many/material-%03d.binary" % n, fixtures.table(n + 1, (4 + n % 3, 5, 6)), (4 + n % 3, 5, 6))
END
for profile in paper spectral; do
	"$build/brdfpack" build --any-lattice -q --profile $profile -o few-$profile.bpk few
done
"$build/brdfpack" build --any-lattice -q -o many.bpk many
# All damage is opened, verified, loaded and evaluated. What takes longer is sampled: the first number says how often it is listed and
# extracted, the second how often recovered. Odd ones, so that a walk through bits meets each of a byte's eight.
if [ -n "$long" ]; then
	mutations=100000 truncate=(-x 1 -r 1) flip=(-x 1 -r 7) mutate=(-x 1 -r 11)
else
	mutations=1600 truncate=(-x 1 -r 31) flip=(-x 21 -r 401) mutate=(-x 5 -r 41)
fi
for profile in paper spectral; do
	"$asan/tests/faults" "${truncate[@]}" truncate few-$profile.bpk
	"$asan/tests/faults" "${flip[@]}" flip few-$profile.bpk
done
"$asan/tests/faults" "${mutate[@]}" mutate many.bpk "$mutations"
# without the allocator's cache of freed pieces, which it counts as in use
GLIBC_TUNABLES=glibc.malloc.tcache_count=0 "$build/tests/faults" load many.bpk 10000
"$build/tsan/tests/faults" threads many.bpk 100
# the half that writes, as a library
mkdir written
LD_PRELOAD=$build/tests/fault_shim.so "$build/tests/write_faults" starve written
"$build/tsan/tests/write_faults" threads
"$asan/tests/write_faults" hostile
# shellcheck disable=SC2086
python3 "$here/faults.py" "$build/brdfpack" "$build/tests/fault_shim.so" $long
