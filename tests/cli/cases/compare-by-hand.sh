# The figures of compare, worked out again from the independent reader's values and the definitions.
fixture alpha
build -q --profile paper -o out.bpk alpha.binary
top=$(cd "$(dirname "$0")/../../.." && pwd)
[ -e "$top/scripts/read_bpk.py" ] || { echo "skip: no scripts/read_bpk.py"; exit; }
python3 "$top/scripts/read_bpk.py" decode out.bpk alpha >decoded.json
brdfpack compare --json --size 16 out.bpk . | head -n 1 >row.json
python3 "$top/tests/compare_by_hand.py" decoded.json alpha.binary 16 <row.json
