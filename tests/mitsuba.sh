#!/usr/bin/env bash
# Mitsuba 3: the plugin, its own `measured` with files of `extract --format bsdf`, and its evaluation of published .bsdf files (RGL) against our records of them, where BRDFPACK_RGL or a sibling
# folder ../shared/data/rgl has some: tests/mitsuba.sh BUILD. Ends with 77, and why, where Mitsuba or the package cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."
tool=$PWD/$1/brdfpack
scripts/mitsuba_venv.sh
venv=build/mitsuba-venv
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r Makefile src "$scratch"
"$venv/bin/pip" --disable-pip-version-check -q install --force-reinstall --no-deps "$scratch/src/python" >"$scratch/log" 2>&1 ||
	{ tail -n 5 "$scratch/log"; echo "the package does not build"; exit 1; }
"$venv/bin/pip" --disable-pip-version-check -q install cffi >"$scratch/log" 2>&1 || { echo "skip: pip does not reach cffi"; exit 77; }

names=(wine-velvet terracotta blue-car-paint beetle-wing)
# matte, glossy plastic, rough metal, metallic paint with two lobes: the least dB of a sphere under point lights
files=(terracotta:45 red-toy-plastic:45 cast-aluminium:45 blue-car-paint:40)
"$tool" synth "$scratch/all"
inputs=()
for name in "${names[@]}" red-toy-plastic cast-aluminium; do inputs+=("$scratch/all/$name.binary"); done
"$tool" build -q -o "$scratch/demo.bpk" "${inputs[@]}"
rm -r "$scratch/all"
"$tool" extract --format bsdf -C "$scratch/files" "$scratch/demo.bpk" "${files[@]%:*}"
"$tool" extract --format bsdf --spectral -C "$scratch/spectral" "$scratch/demo.bpk" "${files[@]%:*}"
in_mitsuba() { "$venv/bin/python" "tests/mitsuba_$1.py" "$2" "$tool" "$scratch/demo.bpk" "${@:3}"; }
in_mitsuba plugin scalar_rgb "$scratch" "${names[@]}"
in_mitsuba files scalar_rgb "$scratch/files" "${files[@]}"
in_mitsuba files scalar_spectral "$scratch/spectral" "${files[@]}"
rgl=${BRDFPACK_RGL:-../shared/data/rgl}
if compgen -G "$rgl/*_rgb.bsdf" >/dev/null; then
	"$venv/bin/python" tests/mitsuba_measured.py "$tool" "$rgl" "$scratch"
else
	echo "skipped: Mitsuba's measured against our records, as there are no files of the RGL database (BRDFPACK_RGL=FOLDER)"
fi
# Dr.Jit's newest versions want more of LLVM than Debian 12's own version has
for library in /usr/lib/*/libLLVM-1[5-9].so /usr/lib/*/libLLVM-[2-9]?.so; do [ ! -e "$library" ] || export DRJIT_LIBLLVM_PATH=$library; done
[ -n "${DRJIT_LIBLLVM_PATH:-}" ] || { echo "skip: llvm_ad_rgb, as there is no LLVM of version 15 or later (apt-get install libllvm19)"; exit 77; }
in_mitsuba plugin llvm_ad_rgb "$scratch" "${names[@]}"
in_mitsuba files llvm_ad_rgb "$scratch/files" "${files[@]}"
