# --format json writes the parameters.
fixture alpha
build -o out.bpk .
code brdfpack extract --format json -C x out.bpk
ls x
python3 - <<'END'
import json
d = json.load(open("x/alpha.json"))
print(d["name"], d["profile"], d["lattice"]["theta_h"], sorted(d["parameters"]), d["source"]["bytes"])
END
