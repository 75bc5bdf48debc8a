# One line per material and a summary line; valid JSON for odd names; numbers are finite or null.
fixture alpha dirty truncated
mv alpha.binary 'al"ph\a é.binary'
code build --json -o out.bpk . >lines 2>errors
tail -n 1 lines
python3 - <<'END'
import json
for line in open("lines"):
    if line.startswith("exit"):
        continue
    d = json.loads(line, parse_constant=lambda c: 1 / 0)
    d.pop("seconds", None)
    stages = d.pop("cpu_seconds", None)
    if stages:
        print(list(stages), min(stages.values()) >= 0)
    if "errors" in d:
        d["errors"] = sorted(d["errors"])
        d["parameters"] = {c: sorted(p) for c, p in d["parameters"].items()}
        d["bytes"] = d["bytes"] > 0
        d.pop("left_out")
    if "summary" in d:
        d["bytes"] = d["bytes"] > 0
    print(json.dumps(d, ensure_ascii=False))
END
cat errors
