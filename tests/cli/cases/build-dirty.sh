# Cells that are NaN or infinite are counted, and a warning says so; -q leaves it out.
fixture alpha dirty
code build -o out.bpk .
code build -q -o quiet.bpk .
cmp out.bpk quiet.bpk && echo same
brdfpack list out.bpk dirty | grep infinite
