#!/usr/bin/env bash
# From a fresh clone to an archive: installs what is missing, builds, makes the demo materials,
# packs them, lists and verifies the archive, extracts one material, and makes a page that shows them all.
#
#     scripts/demo.sh [FOLDER]      default: build/demo; needs about 700 MB there
#
# Where emscripten is installed (scripts/setup.sh viewer) the page is live. The picture at the front of the README
# is made as well, FOLDER/front.svg, where there is Python.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/demo}

scripts/setup.sh build
make -s -j"$(nproc)" all
embed=()
if command -v emcc >/dev/null; then make -s -j"$(nproc)" viewer && embed=(--embed); fi
mkdir -p "$folder"

run() {
	echo
	echo "\$ brdfpack $*"
	build/brdfpack "$@"
}
run synth "$folder/materials"
run build -o "$folder/demo.bpk" "$folder/materials"
run list "$folder/demo.bpk"
run verify --deep "$folder/demo.bpk"
first=$(build/brdfpack list --json "$folder/demo.bpk" | sed -n '1s/^{"name": "\([^"]*\)".*/\1/p')
run list "$folder/demo.bpk" "$first"
run extract -C "$folder/extracted" "$folder/demo.bpk" "$first"
echo
ls -l "$folder/demo.bpk" "$folder/materials/$first.binary" "$folder/extracted/$first.binary"
if command -v python3 >/dev/null; then scripts/front_picture.py build/brdfpack "$folder/materials" "$folder/front.svg"; fi
run report -o "$folder/report.html" --measured "$folder/materials" "${embed[@]}" "$folder/demo.bpk"
echo
echo "See it: open $folder/report.html in a browser."
