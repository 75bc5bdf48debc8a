#!/bin/sh
# python_reader.sh BUILD: compares the independent reader (scripts/read_bpk.py) with the library.
#
# Every archive of format-spec/vectors must be judged alike, and every decoded value agree to 1e-5; then the
# same for records that were fitted in this very build (BUILD/tests/test_record_encode makes them), and for what both
# evaluate at some angles, to 1e-3: the library's table has 10 bits of mantissa. A slow oracle (paper_oracle.py) works
# out the paper's profile itself.
set -eu
build=${1:?usage: tests/python_reader.sh BUILD}
cd "$(dirname "$0")/.."
reader=scripts/read_bpk.py
vectors=format-spec/vectors
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
count=0
bad=0

fail() {
	echo "python_reader: $1" >&2
	bad=$((bad + 1))
}

# The README's table says what each archive is.
grep '^| [a-z-]*\.bpk' "$vectors/README.md" | sed 's/^| //; s/ | /|/g' >"$folder/table"
while IFS='|' read -r file verdict rest; do
	count=$((count + 1))
	case $verdict in
	ok) word=ok ;;
	"not an archive") word="not ours" ;;
	"unsupported version") word=unsupported ;;
	"checksum differs") word=checksum ;;
	corrupt) word=corrupt ;;
	*) fail "$file: unknown verdict $verdict"; continue ;;
	esac
	said=$(python3 "$reader" verify "$vectors/$file" 2>&1 || true)
	case $said in
	ok | "read_bpk: $vectors/$file: $word at "*) [ "$word" != ok ] && [ "$said" = ok ] && fail "$file: accepted" ;;
	*) fail "$file: expected $word, it said: $said" ;;
	esac
done <"$folder/table"

for values in "$vectors"/*.values; do
	count=$((count + 1))
	python3 "$reader" compare "${values%.values}.bpk" "$values" || fail "$values"
done

count=$((count + 1))
python3 "$reader" list "$vectors/good-origin.bpk" | grep -q "from: RGL tensor file, spectra, 195 wavelengths from 360 to 1000 nm; directions differed by 1.6 % (median), 12.5 %" ||
	fail "good-origin.bpk: what its source was"

"$build/tests/test_record_encode" --write "$folder"
for values in "$folder"/*.values; do
	count=$((count + 1))
	python3 "$reader" verify "${values%.values}.bpk" >"$folder/said" || fail "$values"
	python3 "$reader" compare "${values%.values}.bpk" "$values" || fail "$values"
	looks=${values%.values}.looks
	# shellcheck disable=SC2046 # angles are words
	python3 "$reader" evaluate "${values%.values}.bpk" "$(cut -d' ' -f1 "$values" | head -1)" $(cut -d' ' -f1-3 "$looks") >"$folder/said" || fail "$looks"
	# The library's tables for rendering hold no value below 2^-61.
	paste -d' ' "$looks" "$folder/said" | awk '
		{ for (c = 4; c < 7; c++) if (($c - $(c + 3)) ^ 2 > (1e-3 * $c + 2 ^ -61) ^ 2) bad++ }
		END { exit bad > 0 || NR < 10 }' || fail "$looks"
done

# The paper's profile from a lattice to its table, worked out independently.
count=$((count + 1))
"$build/tests/test_paper" --table >"$folder/table.json"
python3 tests/paper_oracle.py "$folder/table.json" || fail "the oracle of the paper's profile"

echo "python_reader: $count comparisons, $bad failed"
[ "$bad" = 0 ]
