#!/usr/bin/env bash
# The benchmark programs and scripts on small tables: tests/bench.sh BUILD. They must run, every method must have its
# rows, and the tables and plots must come of them; what the figures are is not looked at.
set -euo pipefail
tool=$PWD/$1/brdfpack
program=$PWD/$1/bench/brdfpack-bench
top=$(cd "$(dirname "$0")/.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
fail() { echo "bench.sh: $*"; exit 1; }

"$tool" synth --lattice 12x12x8 all
mkdir in
for name in silvered-mirror terracotta wine-velvet; do mv all/$name.binary in; done
"$program" -q -j 2 -l "small tables" -o table.tsv in
for method in paper spectral spectral-effort ward ward-relative cook-torrance cook-torrance-relative edwards edwards-relative black archimedean tucker zfp zlib zstd xz cat raw-table; do
	rows=$(awk -F '\t' -v method=$method '$2 == method && $1 != "(median)"' table.tsv | wc -l)
	medians=$(awk -F '\t' -v method=$method '$2 == method && $1 == "(median)"' table.tsv | wc -l)
	if [ "$rows" = 0 ] || [ "$rows" != $((3 * medians)) ]; then fail "$method has $rows rows and $medians medians"; fi
done
awk -F '\t' '!/^#/ {if (!fields) fields = NF; if (NF != fields) {print "a row of " NF " fields, not " fields; exit 1}}' table.tsv
"$top/scripts/bench_table.sh" table.tsv >table.md
for row in '| ward' '(the better) |' '| black |' '| spectral |' '| effort |' '| 9 |'; do grep -qF "$row" table.md || fail "no row '$row' in the Markdown table"; done
"$top/scripts/bench_table.sh" table.tsv 4000 >/dev/null
if command -v gnuplot >/dev/null; then
	"$top/scripts/bench_plot.sh" table.tsv plot
	for kind in bytes fit evaluate; do grep -q '</svg>' plot-$kind.svg || fail "plot-$kind.svg is not whole"; done
fi
if "$program" -m nothing in 2>/dev/null || "$program" -e 10 in 2>/dev/null || "$program" missing 2>/dev/null; then
	fail "a wrong command line is taken"
fi

export BRDFPACK=$tool
cd "$top" # for the commit's name
for script in bench_build bench_stages; do
	src/bench/$script.py --any-lattice --runs 1 --label "small tables" "$scratch/in" >"$scratch/$script.txt"
done
for line in '^build -j2 ' 'times as long as reading them once'; do grep -q "$line" "$scratch/bench_build.txt" || fail "bench_build.py: no line '$line'"; done
for stage in read checksum clean regression transform code measure rest '\*\*sum\*\*'; do
	grep -q "^| $stage |" "$scratch/bench_stages.txt" || fail "bench_stages.py: no row for $stage"
done
echo "the benchmarks run"
