# Damaged files are refused with what was expected and found; the others are packed; exit 1.
fixture alpha truncated trailing header extents empty unmeasured
code build -o out.bpk .
brdfpack list out.bpk | cut -d ' ' -f 1
