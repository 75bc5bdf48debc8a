# Median, worst and mean are those of the rows: the worst PSNR is the least one, the worst error the largest.
fixture alpha beta gamma zero
build -q -o out.bpk .
brdfpack compare --size 16 --json out.bpk . >four
brdfpack compare --size 16 --json out.bpk . alpha beta gamma >three
python3 - <<'END'
import json, statistics
for path in ("three", "four"):
    *rows, summary = [json.loads(line) for line in open(path)]
    wrong = [key for key in summary["median"] for name, function in
             (("median", statistics.median), ("mean", statistics.mean), ("worst", min if key.startswith("psnr") else max))
             if abs(function([row[key] for row in rows]) - summary[name][key]) > 1e-9 * max(1, abs(summary[name][key]))]
    print(summary["materials"], summary["failed"], len(summary["median"]), wrong)
END
