#!/usr/bin/env bash
# The shards of OUT.bpk become OUT.bpk: merge.sh BRDFPACK OUT.bpk N. Says what failed; without it, removes the shards.
set -uo pipefail
tool=$1 output=$2 n=$3
folder=$output.shards
archives=()
missing=0
for k in $(seq "$n"); do
	if [ -e "$folder/$k.bpk" ] && grep -q '"summary": true.*"written": true' "$folder/$k.json" 2>/dev/null; then
		archives+=("$folder/$k.bpk")
	else
		echo "shard $k/$n: not there: $(tail -n 1 "$folder/$k.err" 2>/dev/null || echo 'it has not run')"
		missing=$((missing + 1))
	fi
done
# every shard tells of an input that cannot be read
refusals=$(cat "$folder"/*.json | grep -h '"error": ' | sort -u)
refused=$(grep -c . <<<"$refusals" || true)
[ "$refused" = 0 ] || sed 's/^/refused: /' <<<"$refusals"
if [ "$missing" != 0 ]; then
	echo "$missing of $n shards are missing; $output: not written. Submit again: only what is missing is made"
	exit 1
fi
"$tool" merge --expect "$n" -o "$output" "${archives[@]}" || exit 1
echo "$refused materials refused"
[ "$refused" = 0 ] || exit 1
rm -r "$folder"
