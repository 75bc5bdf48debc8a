# Names that a terminal would obey or that look like others: escaped for people, exact in JSON; columns align for wide ones.
fixture alpha
for n in $'a\xe2\x80\xaeb' $'zero\xe2\x80\x8bwidth' '金属' 'plain'; do cp alpha.binary "$n.binary"; done
rm alpha.binary
build -o out.bpk .
brdfpack list out.bpk | sed 's/ *[0-9]* *spectral.*//' | cat -v
brdfpack list --json out.bpk | python3 -c 'import json,sys
print(ascii(sorted(json.loads(l)["name"] for l in sys.stdin if "\"name\"" in l)))'
brdfpack list out.bpk | python3 -c 'import sys,unicodedata
def columns(text): return sum(0 if unicodedata.combining(c) else 2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text)
rows = sys.stdin.read().split("\n")[1:5]
print("aligned" if len({columns(r[:r.index("spectral")]) for r in rows}) == 1 else rows)'
code brdfpack extract out.bpk $'\x9b31mred'
code brdfpack verify $'no\xe2\x80\xaesuch.bpk'
code brdfpack list $'no\x1b[31m.bpk'
# files too, in what is said of success
evil=$'e\x1b[31mvil'
for c in "subset -o $evil.bpk out.bpk" "merge -o $evil.bpk out.bpk" "recover -o $evil.bpk out.bpk" "verify $evil.bpk"; do brdfpack $c | cat -v; done
damage out.bpk "$evil.bpk" plain
brdfpack verify "$evil.bpk" 2>/dev/null | cat -v
