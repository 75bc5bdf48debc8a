#!/usr/bin/env bash
# The array job on the real engine: tests/slurm.sh BUILD. munged, slurmctld and slurmd of this machine alone: loopback, folders of
# their own, ended by their own pids. Exit code 77: the packages are not there.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
build=$(realpath "${1:-build}")
for program in munged slurmctld slurmd sbatch; do
	command -v $program >/dev/null || { echo "skip: no $program (apt-get install slurm-wlm munge)"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "skip: slurmd starts tasks as their users, which takes root"; exit 77; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/brdfpack-slurm.XXXXXX")
pids=()
finish() {
	local code=$?
	# shellcheck disable=SC2086
	[ -z "${array:-}" ] || timeout 10 scancel $array ${merge:-} 2>/dev/null
	for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null; done
	for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null; done
	[ "$code" = 0 ] || tail -n 20 "$scratch"/*.log "$scratch"/out.bpk.shards/*.log "$scratch"/out.bpk.shards/*.err 2>/dev/null
	rm -rf "$scratch"
}
trap finish EXIT
fail() {
	echo "slurm: $*"
	exit 1
}
export BRDFPACK=$build/brdfpack
mkdir -p "$scratch"/{state,spool,munge}
chmod 700 "$scratch/munge"
head -c 1024 /dev/urandom >"$scratch/munge/key"
chmod 400 "$scratch/munge/key"
port=$((20000 + $$ % 20000))
cat >"$scratch/slurm.conf" <<CONF
ClusterName=brdfpack
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$scratch/munge/socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SchedulerParameters=batch_sched_delay=1,sched_interval=2,bf_interval=2
KillWait=3
SlurmdParameters=config_overrides
NodeName=localhost NodeAddr=127.0.0.1 CPUs=4 RealMemory=8000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$scratch/slurm.conf
munged --foreground --force --key-file="$scratch/munge/key" --socket="$scratch/munge/socket" --pid-file="$scratch/munge/pid" \
	--log-file="$scratch/munge/log" --seed-file="$scratch/munge/seed" >"$scratch/munged.log" 2>&1 &
pids+=($!)
slurmctld -D >"$scratch/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -N localhost >"$scratch/slurmd.log" 2>&1 &
pids+=($!)
for _ in $(seq 60); do
	sinfo -h -o %T 2>/dev/null | grep -q idle && break
	sleep 0.5
done
sinfo -h -o %T | grep -q idle || fail "no idle node"

# Whether job $1 has left the queue, in at most $2 seconds.
gone() {
	for _ in $(seq $((2 * $2))); do
		[ -n "$(squeue -h -j "$1" 2>/dev/null)" ] || return 0
		sleep 0.5
	done
	return 1
}
"$BRDFPACK" synth --lattice 24x24x48 "$scratch/in" || fail "no materials"
"$BRDFPACK" build -q --any-lattice -o "$scratch/plain.bpk" "$scratch/in" || fail "no archive to compare with"

grep -q BRDFPACK_TEST_SLEEP "$BRDFPACK" || { echo "skip: this brdfpack is built without -DBRDFPACK_TEST_HOOKS"; exit 77; }
# Every material takes a second more, so that there is a middle to kill a task in.
export BRDFPACK_TEST_SLEEP=1
line=$(scripts/slurm/submit.sh -n 4 -c 1 -o "$scratch/out.bpk" -- --any-lattice "$scratch/in") || fail "not submitted: $line"
echo "$line"
array=$(sed 's/.*job \([0-9]*\) (array.*/\1/' <<<"$line")
# the journal of shard 2's archive
journal=.brdfpack-$(python3 -c 'import zlib; print("%08x" % zlib.crc32(b"2.bpk"))')-journal
merge=$(sed 's/.*merge: job \([0-9]*\);.*/\1/' <<<"$line")
scontrol hold "$merge" # until the shards have been looked at
# In the middle: a record of task 2 is finished, which is more than the journal's header, and others are not.
for _ in $(seq 600); do
	[ "$(find "$scratch/out.bpk.shards" -name "$journal" -size +300c | wc -l)" = 1 ] && break
	sleep 0.1
done
scontrol requeue "${array}_2" || fail "task 2 cannot be requeued"
gone "$array" 120 || fail "the array does not end"
resumed=$(grep -c '"record": *"resumed"' "$scratch/out.bpk.shards/2.json")
[ "$resumed" -gt 0 ] || fail "the requeued task made all records anew"
[ -z "$(find "$scratch/out.bpk.shards" -name '.brdfpack-*')" ] || fail "a journal is left"
scontrol release "$merge"
gone "$merge" 60 || fail "the merge does not end"
[ -e "$scratch/out.bpk" ] || fail "no archive"
cmp "$scratch/plain.bpk" "$scratch/out.bpk" || fail "another archive than that of one build"
[ ! -e "$scratch/out.bpk.shards" ] || fail "the shards are still there"

# Without Slurm, and submitted again after a shard was lost.
unset BRDFPACK_TEST_SLEEP
mkdir "$scratch/local.bpk.shards"
echo 4 >"$scratch/local.bpk.shards/count"
scripts/slurm/submit.sh -l -n 4 -c 1 -o "$scratch/local.bpk" -- --any-lattice "$scratch/in" | tail -n 3
cmp "$scratch/plain.bpk" "$scratch/local.bpk" || fail "under xargs: another archive than that of one build"
echo "4 shards on Slurm, one requeued in the middle ($resumed of its records resumed), and under xargs: the archive of one build"
