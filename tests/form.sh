#!/usr/bin/env bash
# Every C source has the form that .clang-format gives it: names those that have not, and shows the first lines that differ.
#
#     tests/form.sh [FOLDER]        FOLDER holds .clang-format and the sources (default: the project's own)
set -uo pipefail
cd "${1:-$(dirname "$0")/..}" || exit 1

# the newest stable release writes some things otherwise, so one version decides
command -v clang-format-14 >/dev/null || {
	echo "skip: clang-format-14 is not installed"
	exit 77
}
differ=0
while IFS= read -r file; do
	if ! changes=$(clang-format-14 "$file" | diff "$file" -); then
		differ=$((differ + 1))
		echo "$file: not as clang-format-14 -i leaves it:"
		head -n 6 <<<"$changes"
	fi
done < <(find src tests format-spec -name build -prune -o \( -name '*.c' -o -name '*.h' \) -print | sort)
[ "$differ" = 0 ] || exit 1
