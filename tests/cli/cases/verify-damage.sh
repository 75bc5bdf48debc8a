# Damage is named with its place; the other materials are still listed and extracted.
fixture alpha beta gamma
build -o out.bpk .
damage out.bpk out.bpk beta
code brdfpack verify out.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
code brdfpack extract -C x out.bpk 2>&1 | sed 's/offset [0-9]*/offset N/'
ls x
