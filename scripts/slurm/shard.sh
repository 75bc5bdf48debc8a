#!/usr/bin/env bash
# One shard: shard.sh BRDFPACK OUT.bpk K N CORES BUILD-ARGUMENT... An empty K is the array task's number.
# Exit code 0 also where materials were refused: they stand in K.json, and the merge's summary tells them.
set -uo pipefail
tool=$1 output=$2 k=${3:-${SLURM_ARRAY_TASK_ID:?}} n=$4 cores=$5
shift 5
folder=$output.shards
# --update: what an older run of this shard finished is taken from it
"$tool" build -q --json --update --shard "$k/$n" -j "$cores" -o "$folder/$k.bpk" "$@" >"$folder/$k.json" 2> >(tee "$folder/$k.err" >&2)
code=$?
echo "shard $k/$n on $(uname -n): exit code $code"
[ "$code" = 0 ] || { [ "$code" = 1 ] && grep -q '"summary": true.*"written": true' "$folder/$k.json"; }
