# Members in the reverse order of their names: read once from front to end, reported by name all the same.
fixture alpha beta gamma
python3 - <<'PY'
import zipfile
with zipfile.ZipFile("reversed.zip", "w", zipfile.ZIP_DEFLATED) as z:
    for n in reversed(range(3000)):
        z.write("beta.binary" if n % 2 else "alpha.binary", "m%05d.binary" % n)
PY
build -o folder.bpk --json reversed.zip >lines
python3 - <<'PY'
import json
names = [json.loads(line)["name"] for line in open("lines") if '"name"' in line]
print(len(names), "in order" if names == sorted(names) else "out of order")
PY
