#!/usr/bin/env bash
# The report and the viewer: tests/viewer.sh BUILD [SHOTS]. The WebAssembly reader against the test vectors in Node, then the page in Debian's
# Chromium, headless. Needs node and chromium (scripts/setup.sh viewer), and BUILD/viewer (`make viewer`); 77 and a word where one is missing.
# Screenshots for people go to SHOTS.
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd)
shots=${2:-$build/viewer-shots}
for program in node chromium; do
	command -v $program >/dev/null || { echo "skip: $program is not here; scripts/setup.sh viewer installs it"; exit 77; }
done
[ -f "$build/viewer/viewer.html" ] || { echo "skip: the viewer was not built, emcc is not here; scripts/setup.sh viewer installs it"; exit 77; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$shots" "$scratch/measured"
shots=$(cd "$shots" && pwd)
tool=$build/brdfpack
names="gold-spray-paint silvered-mirror wine-velvet"

grep -q '<h1>.*no archive yet' "$build/viewer/index.html" # what stands in the empty page's place of a name

size=$(gzip -9 -c "$build/viewer/viewer.wasm" | wc -c)
echo "viewer.wasm: $size bytes compressed"
[ "$size" -le 200000 ] || { echo "viewer.sh: more than 200 KB"; exit 1; }

cd "$scratch"
"$tool" synth all
for name in $names; do mv "all/$name.binary" measured; done
rm -r all
"$tool" build -q -o three.bpk measured
start=$(date +%s%N)
"$tool" report -q -j1 --measured measured -o report.html three.bpk
echo "a report of three materials beside their files: $((($(date +%s%N) - start) / 1000000)) ms on one core (asked: at most 2000 each)"
"$tool" report -q --light key --embed -o embedded.html three.bpk

# a record in the middle is damaged
python3 "$top/tests/damage.py" three.bpk damaged.bpk silvered-mirror
if "$tool" report -q -o damaged.html damaged.bpk 2>said; then echo "viewer.sh: a report of a damaged archive exits with 0"; exit 1; fi
grep -q silvered-mirror said
"$tool" report -q -o empty.html "$top/format-spec/vectors/good-empty.bpk"

# odd names, and many of them
python3 "$top/tests/cli/fixtures.py" .
mkdir odd many
python3 - <<'PYTHON'
import json, os, shutil
odd = ['a "quoted" \'name\'', "<img src=x onerror=window.ran=1>&amp;", "<script>window.ran=2<\\script>", "\u0645\u0627\u062f\u0629 \u0661", "\u202eturned"]
for name in odd:
    shutil.copy("alpha.binary", os.path.join("odd", name + ".binary"))
with open("odd.json", "w") as file:
    json.dump(odd, file)
for n in range(200):
    os.link("beta.binary", f"many/material-{n:03}.binary")
PYTHON
"$tool" build -q --any-lattice -o odd.bpk odd
"$tool" report -q --embed -o odd.html odd.bpk
"$tool" build -q --any-lattice -o many.bpk many
"$tool" report -q -o many.html many.bpk

cd "$top"
node tests/viewer_vectors.js "$build" "$scratch/three.bpk"
node tests/viewer_page.js "$(command -v chromium)" "$tool" "$scratch" "$shots"
echo "screenshots: $shots"
