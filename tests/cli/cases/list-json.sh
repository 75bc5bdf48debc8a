# JSON lines: every number is finite or null, and the facts of the source are there.
fixture alpha beta
build -o out.bpk .
brdfpack list --json out.bpk >lines
brdfpack list --json out.bpk beta >>lines
python3 - <<'END'
import json
for line in open("lines"):
    d = json.loads(line, parse_constant=lambda c: 1 / 0)
    print(d.get("name"), d.get("materials"), sorted(d))
END
