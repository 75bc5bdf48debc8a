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
portable() { # portable NAME FLAG...: a program of the reader's sources alone
	local name=$1 source
	shift
	mkdir -p "$scratch/$name"
	for source in "${sources[@]}"; do
		local extra=()
		[[ $source != *_avx2.c ]] || extra=(-mavx2)
		cc "${flags[@]}" -DBP_PORTABLE -ffunction-sections -fdata-sections "$@" "${extra[@]}" -c -o "$scratch/$name/${source//\//-}.o" "$source"
	done
	cc "$@" -Wl,--gc-sections -o "$scratch/$name/reader" -Isrc tests/reader_values.c "$scratch/$name"/*.o -lm
}
portable stdc
ways=("$scratch/stdc/reader")
# not gcc-multilib, which no cross compiler may stand beside: what it would add is the link to these headers
m32=(-m32 -msse2 -mfpmath=sse -idirafter /usr/include/x86_64-linux-gnu)
if printf '#include <errno.h>\n#include <stdio.h>\nint main(void) { return errno; }\n' | cc "${m32[@]}" -x c -o "$scratch/probe32" - 2>/dev/null && "$scratch/probe32"; then
	portable m32 "${m32[@]}" -D_FILE_OFFSET_BITS=64
	ways+=("$scratch/m32/reader")
else
	echo "no 32-bit libc here (apt-get install libc6-dev-i386 lib32gcc-12-dev): that one is left out"
fi
for profile in paper spectral; do
	expected=$("$scratch/reader" "$scratch/$profile.bpk")
	echo "$profile: $expected"
	for way in "${ways[@]}"; do [ "$("$way" "$scratch/$profile.bpk")" = "$expected" ] || { echo "$way gives $("$way" "$scratch/$profile.bpk")"; exit 1; }; done
done
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
sentence="little-endian machines" refused -U__BYTE_ORDER__ -D__BYTE_ORDER__=__ORDER_BIG_ENDIAN__
sentence="precision of its operands" refused -U__FLT_EVAL_METHOD__ -D__FLT_EVAL_METHOD__=2
sentence="gcc 12 or clang 14" refused -U__GNUC__ -D__GNUC__=11
