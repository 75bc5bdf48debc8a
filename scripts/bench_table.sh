#!/bin/sh
# bench_table.sh TABLE.tsv [BUDGET]: the table of methods in RESULTS.md, as Markdown: one row per method at BUDGET bytes (60400) or
# at the method's own size, the sphere's PSNR under the key lights per material, and medians; the log RMSE is that of the cells that
# can be seen. Of an analytic model by two objectives the one with the better mean PSNR is named. Under it the figures that the paper
# prints for its own method and its rivals; then, if the run had any, the means for each effort (means, because efforts differ by
# less than materials do).
set -e
table=$1 budget=${2:-60400}
[ -r "$table" ] || { echo "usage: bench_table.sh TABLE.tsv [BUDGET]" >&2; exit 2; }
awk -F '\t' -v budget="$budget" '
	/^# (machine|compiler|commit|data|figures against|command|processes):/ {sub(/^# /, ""); head = head "    " $0 "\n"}
	/^#/ {next}
	$1 == "material" {for (n = 1; n <= NF; n++) column[$n] = n; next}
	{
		size = $(column["budget_bytes"])
		if (size != "-" && size != budget || $(column["seen_log_rmse"]) == "-") next
		method = $2
		if (("effort" in column) && $(column["effort"]) != "-") {
			if ($1 != "(median)")
				effort_add($(column["effort"]))
			next
		}
		if ($1 == "(median)") {
			order[++methods] = method
			bytes[method] = $(column["bytes"]); numbers[method] = $(column["parameters"]) == "-" ? "" : $(column["parameters"]); fit[method] = $(column["fit_s"]); decode[method] = $(column["decode_s"])
			evaluate[method] = $(column["evaluate_ns"]); rmse[method] = $(column["seen_log_rmse"])
			all[method] = $(column["psnr_key_db"]) " / " $(column["psnr_env_db"])
		} else {
			if (!($1 in seen)) {seen[$1] = 1; materials[++count] = $1}
			psnr[method, $1] = $(column["psnr_key_db"])
		}
	}
	function published(who, values,    parts, n, line, any) {
		n = split(values, parts, " ")
		for (n = 1; n in parts; n += 2) value[parts[n]] = parts[n + 1]
		line = "| *" who " (published)* | | | | | | | |"
		for (n = 1; n <= count; n++) {
			line = line " " (materials[n] in value ? "*" value[materials[n]] "*" : "") " |"
			any += materials[n] in value
		}
		split("", value)
		if (any) print line
	}
	function effort_add(e) {
		if (!(e in tried)) effort[++efforts] = e
		tried[e]++
		size_sum[e] += $(column["bytes"]); fit_sum[e] += $(column["fit_s"]); rmse_sum[e] += $(column["seen_log_rmse"])
		key_sum[e] += $(column["psnr_key_db"]); env_sum[e] += $(column["psnr_env_db"])
	}
	function table_of_efforts(    text, n, e, k) {
		text = "\n| effort | bytes | fit s | seen log RMSE | PSNR key / env |\n|--:|--:|--:|--:|--:|\n"
		for (n = 1; n <= efforts; n++) {
			e = effort[n]; k = tried[e]
			text = text sprintf("| %s | %.0f | %.3g | %.6f | %.2f / %.2f |\n", e, size_sum[e] / k, fit_sum[e] / k, rmse_sum[e] / k, key_sum[e] / k, env_sum[e] / k)
		}
		return text
	}
	function mean_of(method,    n, sum) {
		for (n = 1; n <= count; n++) sum += psnr[method, materials[n]]
		return sum / count
	}
	function better_of(method,    base) { # of an analytic model by two objectives, which one serves the pictures better
		base = method; sub(/-relative$/, "", base)
		if (!((base "-relative") in rmse) || !(base in rmse)) return ""
		return method == (mean_of(base) >= mean_of(base "-relative") ? base : base "-relative") ? " (the better)" : ""
	}
	END {
		if (!methods && !efforts) {print "bench_table.sh: no rows at " budget " bytes" > "/dev/stderr"; exit 1}
		printf "%s\n", head
		if (!methods) {printf "%s", substr(table_of_efforts(), 2); exit}
		line = "| method | bytes | numbers | fit s | decode s | evaluate ns | seen log RMSE | PSNR key / env |"; rule = "|---|--:|--:|--:|--:|--:|--:|--:|"
		for (n = 1; n <= count; n++) {line = line " " materials[n] " |"; rule = rule "--:|"}
		print line; print rule
		for (m = 1; m <= methods; m++) {
			method = order[m]
			exact = rmse[method] < 1e-6
			line = sprintf("| %s | %d | %s | %.3g | %.2g | %.3g | %s | %s |", method better_of(method), bytes[method], numbers[method], fit[method], decode[method], evaluate[method], \
				exact ? "0" : sprintf("%.4g", rmse[method]), exact ? "exact" : all[method])
			for (n = 1; n <= count; n++) line = line " " (exact ? "" : psnr[method, materials[n]]) " |"
			print line
		}
		published("Bilgili et al. 2012", "alum-bronze 39.63 blue-metallic-paint 43.16 fruitwood-241 45.74 chrome-steel 26.77 delrin 39.38 yellow-matte-plastic 37.12 gold-metallic-paint 39.40 nickel 41.72")
		published("Ward", "fruitwood-241 29.96 gold-metallic-paint 26.87 nickel 28.20")
		published("Cook-Torrance", "fruitwood-241 42.83 gold-metallic-paint 31.69 nickel 27.82")
		published("Edwards et al.", "fruitwood-241 36.91 gold-metallic-paint 32.99 nickel 24.19")
		published("Bilgili et al. 2011 (Tucker)", "fruitwood-241 42.5 gold-metallic-paint 38.57 nickel 37.88")
		if (efforts) printf "%s", table_of_efforts()
	}' "$table"
