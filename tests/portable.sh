#!/usr/bin/env bash
# The reading half alone, and without the system: what it links, and whether its values stay the same: tests/portable.sh BUILD [MAKE-VARIABLE]...
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
shift
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
read -r -a sources <<<"$(make -s reader-sources)"
flags=(-std=c17 -O1 -Isrc -ffp-contract=off -fno-math-errno -fno-trapping-math -fvisibility=hidden -Wall -Wextra -Werror)

"$build/brdfpack" synth --lattice 12x10x16 "$scratch/materials"
for profile in paper spectral; do
	"$build/brdfpack" build -q --any-lattice --profile $profile -o "$scratch/$profile.bpk" "$scratch/materials"
done

# the installed reader: links no encoder, and imports nothing that writes
cc "${flags[@]}" -o "$scratch/reader" tests/reader_values.c "$build/libbrdfpack_reader.a" -lz -lm
if nm "$build/libbrdfpack_reader.a" | grep -E ' U (rename|fsync|unlink|write|fwrite|creat|mkstemp|link|linkat)$'; then
	echo "the reader imports what writes"
	exit 1
fi
if nm "$build/libbrdfpack_reader.a" | grep -iE ' [tdr] .*(encode|_fit\b|_pack|sections_join|writer)' | grep -v table_encode; then
	echo "the reader links an encoder"
	exit 1
fi
nm "$build/libbrdfpack.a" | grep ' U rename$' >/dev/null # where both halves are, the same question has another answer
nm "$build/libbrdfpack.a" | grep -i ' t spectral_encode' >/dev/null

# -DBP_PORTABLE: standard C alone, whatever the system
cc "${flags[@]}" -DBP_PORTABLE -mno-avx2 -c -o "$scratch/probe.o" src/system.c
if nm "$scratch/probe.o" | grep -E ' U (open|pread|fstat|madvise|clock_gettime|posix_memalign)'; then
	echo "-DBP_PORTABLE leaves something of the system"
	exit 1
fi
portable() { # portable NAME COMPILER FLAG...: a program of the reader's sources alone
	local name=$1 compiler=$2 source extra
	shift 2
	mkdir -p "$scratch/$name"
	for source in "${sources[@]}"; do
		extra=()
		[[ $source != *_avx2.c || $compiler != cc ]] || extra=(-mavx2)
		[[ $source != *_avx512.c || $compiler != cc ]] || extra=(-mavx512f -mavx512bw -mavx512dq -mavx512vl)
		"$compiler" "${flags[@]}" -DBP_PORTABLE -ffunction-sections -fdata-sections "$@" "${extra[@]}" -c -o "$scratch/$name/${source//\//-}.o" "$source"
	done
	"$compiler" "$@" -std=c17 -Wl,--gc-sections -o "$scratch/$name/reader" -Isrc tests/reader_values.c "$scratch/$name"/*.o -lm "${libraries[@]}"
}
libraries=()
portable stdc cc
ways=("$scratch/stdc/reader")
# not gcc-multilib, which no cross compiler may stand beside: what it would add is the link to these headers
m32=(-m32 -msse2 -mfpmath=sse -idirafter /usr/include/x86_64-linux-gnu)
if printf '#include <errno.h>\n#include <stdio.h>\nint main(void) { return errno; }\n' | cc "${m32[@]}" -x c -o "$scratch/probe32" - 2>/dev/null && "$scratch/probe32"; then
	portable m32 cc "${m32[@]}" -D_FILE_OFFSET_BITS=64
	ways+=("$scratch/m32/reader")
else
	echo "no 32-bit libc here (apt-get install libc6-dev-i386 lib32gcc-12-dev): that one is left out"
fi
# big-endian machines, of 64 and of 32 bits; the second one's 64-bit counters are in libatomic
libraries=(-static -latomic)
for target in s390x:-fexcess-precision=fast mips:-mabi=32; do
	machine=${target%%:*}
	if ! command -v "$machine-linux-gnu-gcc-12" "qemu-$machine" >/dev/null || ! echo 'int main(void) { return 0; }' | "$machine-linux-gnu-gcc-12" -x c - "${libraries[@]}" -o /dev/null 2>/dev/null; then
		echo "no compiler and emulator for $machine here (scripts/setup.sh endian): that one is left out"
		continue
	fi
	portable "$machine" "$machine-linux-gnu-gcc-12" "${target#*:}"
	printf '#!/bin/sh\nexec qemu-%s %s "$@"\n' "$machine" "$scratch/$machine/reader" >"$scratch/$machine/run"
	chmod +x "$scratch/$machine/run"
	ways+=("$scratch/$machine/run")
done
compare() { # compare ARCHIVE: what the installed reader makes of it, all others make of it
	local expected got way
	expected=$("$scratch/reader" "$1" 2>&1) || true
	echo "$(basename "$1"): $expected"
	for way in "${ways[@]}"; do
		got=$("$way" "$1" 2>&1) || true
		[ "$got" = "$expected" ] || { echo "$way gives $got"; exit 1; }
	done
}
for archive in "$scratch"/paper.bpk "$scratch"/spectral.bpk format-spec/vectors/*.bpk; do compare "$archive"; done
# and damage is damage there too
head -c -1 "$scratch/paper.bpk" >"$scratch/cut.bpk"
for way in "${ways[@]}"; do
	if "$way" "$scratch/cut.bpk" 2>/dev/null || "$way" "$scratch/none.bpk" 2>/dev/null || "$way" "$scratch" 2>/dev/null; then exit 1; fi
done

# what cannot be supported is refused with a sentence
refused() {
	if cc -fsyntax-only -Isrc "$@" -include src/system.h -x c /dev/null 2>"$scratch/says"; then exit 1; fi
	grep -q "$sentence" "$scratch/says"
}
sentence="writing half of brdfpack is for little-endian machines" refused -D_GNU_SOURCE -U__BYTE_ORDER__ -D__BYTE_ORDER__=__ORDER_BIG_ENDIAN__ -include src/merl/merl_file.c
sentence="precision of its operands" refused -U__FLT_EVAL_METHOD__ -D__FLT_EVAL_METHOD__=2
sentence="gcc 12 or clang 14" refused -U__GNUC__ -D__GNUC__=11
