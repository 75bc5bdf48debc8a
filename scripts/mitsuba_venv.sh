#!/usr/bin/env bash
# A virtual environment with Mitsuba 3 for the jobs that test with it: mitsuba_venv.sh [FOLDER], build/mitsuba-venv unless told. Made once; ends with
# 77 where pip reaches no package index.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/mitsuba-venv}
if ! "$folder/bin/python" -c "import mitsuba, numpy" 2>/dev/null; then
	mkdir -p "$(dirname "$folder")"
	"${PYTHON:-python3}" -m venv "$folder" >/dev/null || { echo "skip: no venv (apt-get install python3-venv)"; exit 77; }
	"$folder/bin/pip" --disable-pip-version-check -q install "mitsuba>=3.5" numpy >"$folder/log" 2>&1 || { echo "skip: pip does not reach Mitsuba 3"; exit 77; }
fi
