#!/usr/bin/env bash
# The Python package, as a new user has it: a wheel built in a clean virtual environment, its tests, the README's lines, the example;
# then its source distribution, installed for whatever other versions of Python are here: tests/python_package.sh BUILD. Ends with 77
# where pip cannot reach what the package wants.
set -euo pipefail
cd "$(dirname "$0")/.."
tool=$PWD/$1/brdfpack
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$scratch/venv" 2>"$scratch/log" || { echo "skip: $python has no venv (apt-get install python3-venv)"; exit 77; }
pip=("$scratch/venv/bin/pip" --disable-pip-version-check -q)
# setuptools, wheel and cffi are what a build wants, the last and NumPy what the package does
"${pip[@]}" download -d "$scratch/reach" "setuptools>=64" wheel cffi numpy >"$scratch/log" 2>&1 || { echo "skip: pip reaches no package index"; exit 77; }
# the sources are copied: a build must want nothing of this folder, and leave nothing in it
mkdir "$scratch/tree"
cp -r Makefile src format-spec "$scratch/tree"
rm -rf "$scratch/tree/src/python/build"
"${pip[@]}" wheel --no-deps -w "$scratch/wheel" "$scratch/tree/src/python"
"$python" -m venv "$scratch/maker"
"$scratch/maker/bin/pip" --disable-pip-version-check -q install --find-links "$scratch/reach" "setuptools>=64" wheel cffi
(cd "$scratch/tree/src/python" && "$scratch/maker/bin/python" -c 'import sys; from setuptools import build_meta; build_meta.build_sdist(sys.argv[1])' "$scratch/sdist") >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
if grep "standard file not found" "$scratch/log"; then exit 1; fi # no README
rm -rf "$scratch/tree/src"
"${pip[@]}" install --find-links "$scratch/reach" "$scratch"/wheel/brdfpack-*.whl
cd "$scratch"
"$scratch/venv/bin/python" "$OLDPWD/tests/python_package.py" "$tool"

mkdir -p build/demo
"$tool" synth --lattice 12x10x16 materials
"$tool" build -q --any-lattice -o build/demo/demo.bpk materials
sed -n '/^```python$/,/^```$/p' "$OLDPWD/README.md" | sed '/^```/d' >lines.py
[ "$(wc -l <lines.py)" -ge 10 ]
"$scratch/venv/bin/python" lines.py
"$tool" verify --deep out.bpk
"$scratch/venv/bin/python" tree/format-spec/example/sphere.py build/demo/demo.bpk wine-velvet sphere.png
[ "$(head -c 8 sphere.png | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ]
[ "$("$scratch/venv/bin/python" -c 'import zlib; d = open("sphere.png", "rb").read(); print(len(set(zlib.decompress(d[41:-16]))) > 100)')" = True ]
# Mitsuba is not here, and the module that wants it says what to do
said=$("$scratch/venv/bin/python" -c 'import brdfpack.mitsuba' 2>&1 || true)
[[ $said == *"pip install mitsuba"* ]]

# the source distribution has all that it wants, and the version of the header
sdist=("$scratch"/sdist/brdfpack-*.tar.gz)
version=$(sed -n 's/^#define BP_VERSION "\(.*\)"/\1/p' "$OLDPWD/src/brdfpack.h")
[ "$(basename "${sdist[0]}")" = "brdfpack-$version.tar.gz" ]
tested=
for other in 3.9 3.10 3.11 3.12 3.13 3.14; do
	for found in "$(command -v "python$other" || true)" $(ls -d "$(pyenv root 2>/dev/null || echo none)"/versions/"$other".*/bin/python 2>/dev/null); do
		if [ -n "$found" ] && "$found" -m venv "$scratch/venv-$other" 2>/dev/null; then
			"$scratch/venv-$other/bin/pip" --disable-pip-version-check -q install "${sdist[0]}"
			"$scratch/venv-$other/bin/python" -W error::DeprecationWarning "$OLDPWD/tests/python_package.py" "$tool"
			tested+=" $other"
			rm -rf "$scratch/venv-$other"
			continue 2
		fi
	done
	echo "Python $other: skipped, not here"
done
echo "source distribution: installed and tested with Python$tested"
