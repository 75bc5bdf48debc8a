#!/bin/sh
# bench_plot.sh TABLE.tsv OUT: plots of run time against error, from brdfpack-bench's medians, one line per method:
#
#   OUT-bytes.svg     error against bytes
#   OUT-fit.svg       error against fit time
#   OUT-evaluate.svg  error against evaluation time
#
# The spectral profile has a second line: its efforts 1 to 9, all at 60,400 bytes.
# Each shows the log RMSE of the cells that can be seen (lower is better) and the rendered sphere's PSNR under the key lights (higher is better).
# The lossless codecs stand outside: their error is 0. With PNG=1 the same as PNG files, for a look.
set -e
table=$1 out=$2
[ -r "$table" ] && [ -n "$out" ] || { echo "usage: bench_plot.sh TABLE.tsv OUT" >&2; exit 2; }
command -v gnuplot >/dev/null || { echo "bench_plot.sh: gnuplot is missing; no plots (apt-get install gnuplot-nox)" >&2; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# One block per method, in the table's order: bytes fit evaluate seen_log_rmse psnr
awk -F '\t' -v work="$work" '
	/^# data:/ {sub(/^# data: /, ""); print > (work "/data")}
	/^#/ {next}
	$1 == "material" {for (n = 1; n <= NF; n++) column[$n] = n; next}
	$1 == "(median)" && $(column["seen_log_rmse"]) != "-" && $(column["seen_log_rmse"]) > 1e-6 {
		if ($2 != last) {
			if (last != "") print "\n" > (work "/points")
			print last = $2 > (work "/methods")
		}
		print $(column["bytes"]), $(column["fit_s"]), $(column["evaluate_ns"]), $(column["seen_log_rmse"]), $(column["psnr_key_db"]) > (work "/points")
	}' "$table"
[ -s "$work/points" ] || { echo "bench_plot.sh: $table holds no medians" >&2; exit 1; }
for kind in svg ${PNG:+png}; do
	gnuplot -e "work='$work'; out='$out'; kind='$kind'" "$(dirname "$0")/bench.gp"
done
