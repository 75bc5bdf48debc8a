#!/usr/bin/env bash
# One archive from many tasks: an array of N shards, then a merge, on Slurm or, without it, under xargs.
#
#     scripts/slurm/submit.sh [-n N] [-c CORES] [-l] -o OUT.bpk [-- BUILD-OPTION...] INPUT...
#
#     -n N       shards (16)
#     -c CORES   processor cores of each shard's task (2)
#     -l         here, without Slurm: as many shards at once as the cores allow
#
# Build options go before the inputs: `-- --profile paper --effort 7 FOLDER`. Beside OUT.bpk a folder OUT.bpk.shards takes the
# shards' archives and logs; it is removed when the merge has written OUT.bpk. Submitted again, only what is missing is made.
# With sbatch's own options in SBATCH_FLAGS (a partition, a time limit): SBATCH_FLAGS="-p long -t 4:00:00" scripts/slurm/submit.sh ...
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
usage() {
	sed -n '2,/^set /s/^# \{0,1\}//p' "$0" | sed '$d' >&2
	exit 2
}
shards=16 cores=2 local=""
output=""
while getopts n:c:lo: option; do
	case $option in
	n) shards=$OPTARG ;;
	c) cores=$OPTARG ;;
	l) local=1 ;;
	o) output=$OPTARG ;;
	*) usage ;;
	esac
done
shift $((OPTIND - 1))
[[ -n $output && $# -gt 0 && $shards =~ ^[1-9][0-9]*$ && $cores =~ ^[1-9][0-9]*$ ]] || usage
tool=$(command -v "${BRDFPACK:-brdfpack}") || { echo "submit.sh: no brdfpack here; install it where every node finds it, or set BRDFPACK" >&2; exit 1; }
tool=$(realpath "$tool")
output=$(realpath -m "$output")
[ -d "$(dirname "$output")" ] || { echo "submit.sh: $(dirname "$output"): no such folder" >&2; exit 1; }
folder=$output.shards
mkdir -p "$folder"
# A shard of another division would be merged in vain.
if [ -e "$folder/count" ] && [ "$(cat "$folder/count")" != "$shards" ]; then
	echo "submit.sh: $folder holds shards of another division ($(cat "$folder/count"), not $shards): remove it, or give -n $(cat "$folder/count")" >&2
	exit 1
fi
echo "$shards" >"$folder/count"
arguments=()
for argument in "$@"; do # inputs by their whole paths: tasks start elsewhere
	if [ -e "$argument" ]; then arguments+=("$(realpath "$argument")"); else arguments+=("$argument"); fi
done

if [ -n "$local" ]; then
	at_once=$(($(nproc) / cores))
	seq "$shards" | xargs -P "$((at_once > 0 ? at_once : 1))" -I '{}' "$here/shard.sh" "$tool" "$output" '{}' "$shards" "$cores" "${arguments[@]}" || true
	exec "$here/merge.sh" "$tool" "$output" "$shards"
fi
command -v sbatch >/dev/null || { echo "submit.sh: no sbatch here; -l works without Slurm" >&2; exit 1; }
# shellcheck disable=SC2086
array=$(sbatch --parsable ${SBATCH_FLAGS:-} --job-name=brdfpack --array="1-$shards" --requeue --open-mode=append --cpus-per-task="$cores" \
	--mem="$((200 * cores + 300))" --output="$folder/%a.log" "$here/shard.sh" "$tool" "$output" "" "$shards" "$cores" "${arguments[@]}")
# afterany: the merge says itself which shards are missing
# shellcheck disable=SC2086
merge=$(sbatch --parsable ${SBATCH_FLAGS:-} --job-name=brdfpack-merge --dependency="afterany:$array" --cpus-per-task=1 --mem=500 \
	--output="$folder/merge.log" --open-mode=append "$here/merge.sh" "$tool" "$output" "$shards")
echo "shards: job $array (array of $shards), merge: job $merge; logs and a summary in $folder"
