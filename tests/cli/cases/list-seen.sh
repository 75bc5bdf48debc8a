# The error of a row, and of the page, is that of the cells that can be seen, not that of the whole table.
brdfpack synth --clean --lattice 24x24x24 demo >/dev/null
build -q --budget 4000 -o out.bpk demo/blue-car-paint.binary
brdfpack list --json out.bpk >out.json
brdfpack list out.bpk >out.txt
brdfpack report -q -o out.html out.bpk
python3 - <<'E2'
import json
import re
fidelity = json.loads(open("out.json").readline())["layers"][-1]
seen, all_cells = fidelity["seen_log_rmse"], fidelity["log_rmse"]
row = next(line for line in open("out.txt") if line.startswith("blue-car-paint")).split()
page = open("out.html").read()
tile = float(re.search(r"data-error=([0-9.e-]+)", page).group(1))
ladder = re.findall(r"<th scope=row>\d+<td>\d+<td>([0-9.]+)<td>([0-9.]+)", page)[-1]
print("differ" if seen < 0.9 * all_cells else "alike")
print(row[4] == f"{seen:.5f}", abs(tile - seen) <= 1e-5 * seen, ladder == (f"{seen:.5f}", f"{all_cells:.5f}"))
E2
