# One aligned row per material and totals.
fixture alpha beta
mv beta.binary 'a long name with spaces é.binary'
build -o out.bpk .
brdfpack list out.bpk | sed 's/-*[0-9][0-9.e-]*/N/g; s/  */ /g'
brdfpack list "$(dirname "$0")/../../../format-spec/vectors/good-empty.bpk"
