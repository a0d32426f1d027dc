#!/usr/bin/env bash
# A sweep on Slurm that loses a node: a controller and two virtual nodes on this machine run the script of `whiskmap submit`, one
# node is killed in the middle of a task, and the store must be, file by file, that of a single process. x# the first argument, or builds it. Installs Slurm on Debian and Ubuntu; where that cannot be done it says so and exits with 0,
# or with 1 if WHISKMAP_REQUIRE_CLUSTER=1.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
limit=900 # seconds for each wait

installed() { command -v slurmctld && command -v slurmd && command -v munged; } >/dev/null
install() {
    command -v apt-get >/dev/null &&
        apt-get update -q &&
        apt-get install -y -q --no-install-recommends slurm-wlm munge
}
if [ "$(id -u)" != 0 ] || { ! installed && ! { install && installed; }; }; then
    echo "Slurm cannot be installed here, or not as root: cluster check NOT run"
    exit "${WHISKMAP_REQUIRE_CLUSTER:-0}"
fi

if [ $# -gt 0 ]; then
    whiskmap="$(realpath "$1")"
else
    cargo build --release --locked --manifest-path "$here/../../Cargo.toml"
    whiskmap="$(realpath "$here/../../target/release/whiskmap")"
fi

scratch="$(mktemp -d)"
export SLURM_CONF="$scratch/slurm.conf"

# Prints the processes of this sweep, daemons and tasks; with an argument, those with this line in their environment.
of_sweep() {
    local environment pid
    for environment in $(grep -lzxF "SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ 2>/dev/null); do
        pid="${environment//[^0-9]/}"
        if [ $# = 0 ] || grep -qzxF "$1" "$environment" 2>/dev/null; then echo "$pid"; fi
    done
}

clean_up() {
    local status=$?
    if [ "$status" != 0 ]; then
        echo "FAILED; recent output:"
        squeue || true
        tail -n 20 "$scratch"/*.log "$scratch"/jobs/*.out || true
    fi
    # shellcheck disable=SC2046 # one word for each process
    kill -KILL $(of_sweep) 2>/dev/null || true
    rm -rf "$scratch"
}
trap clean_up EXIT

# Waits until a command succeeds.
wait_until() {
    local end=$((SECONDS + limit))
    until "$@"; do
        if [ "$SECONDS" -ge "$end" ]; then
            echo "timeout after $limit s: $*"
            exit 1
        fi
        sleep 0.05
    done
}

# 1. A controller and two nodes, without systemd, cgroups or a database. x#    machine is late to answer. A task is requeued when its credential has expired.
host="$(hostname -s)"
port=$((20000 + $$ % 3000 * 3))
mkdir "$scratch/state" "$scratch/jobs"
cat >"$SLURM_CONF" <<END
ClusterName=whiskmap
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$scratch/munge.socket,cred_expire=20
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool-%n
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SlurmdTimeout=0
JobRequeue=1
MinJobAge=7200
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=2 RealMemory=1000
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=2 RealMemory=1000
PartitionName=all Nodes=n1,n2 Default=YES
END
echo "CgroupPlugin=cgroup/v1" >"$scratch/cgroup.conf"
(umask 077 && head -c 1024 /dev/urandom >"$scratch/munge.key")
munged --foreground --force --key-file="$scratch/munge.key" --socket="$scratch/munge.socket" \
    --pid-file="$scratch/munge.pid" --seed-file="$scratch/munge.seed" --log-file="$scratch/munged.log" 2>/dev/null &
wait_until test -S "$scratch/munge.socket"
slurmctld -D -c -f "$SLURM_CONF" 2>"$scratch/slurmctld.log" &
slurmd -D -c -f "$SLURM_CONF" -N n1 2>"$scratch/slurmd-n1.log" &
slurmd -D -c -f "$SLURM_CONF" -N n2 2>"$scratch/slurmd-n2.log" &
n2=$!
disown -a # bash would print their end
is_up() { [ "$(sinfo -h -t idle -o %D 2>/dev/null)" = 2 ]; }
wait_until is_up

# 2. The sweep, from a folder whose name needs quotes.
cd "$scratch/jobs"
mkdir "a cluster's"
cp "$here/sweep.toml" "a cluster's/"
shared="$scratch/jobs/a cluster's"
(cd "$shared" && "$whiskmap" submit sweep.toml -o . --shards 8 --partition all --cpus-per-task 2 -- --channels regime,force_un) >sweep.sbatch
job="$(sbatch --parsable sweep.sbatch)"

# 3. A task on the second node that has finished the first of its two blocks is killed, with its node.
has_block() { [ -e "$shared/sweep.zarr/regime/c.$1.0.0" ]; }
is_caught() {
    for task in $(of_sweep SLURMD_NODENAME=n2); do
        [ "$(readlink "/proc/$task/exe")" = "$whiskmap" ] || continue
        shard="$(tr '\0' '\n' <"/proc/$task/environ" | sed -n 's/^SLURM_ARRAY_TASK_ID=//p')"
        has_block "$shard" || continue
        kill -STOP "$task" 2>/dev/null || continue
        has_block "$((shard + 8))" || return 0
        kill -CONT "$task"
    done
    if jobs="$(squeue -h -j "$job" 2>/dev/null)" && [ -z "$jobs" ]; then
        echo "the sweep ended before a task was caught in its middle"
        exit 1
    fi
    return 1
}
wait_until is_caught
kill -KILL "$n2" "$(sed -n 's/^PPid:\t//p' "/proc/$task/status")" "$task"
scontrol update NodeName=n2 State=DOWN Reason=killed
echo "killed node n2 and, in its middle, shard $shard"

# 4. Slurm restarts that task, on the other node; all tasks and the closing status succeed.
is_over() { jobs="$(squeue -h 2>/dev/null)" && [ -z "$jobs" ]; }
wait_until is_over
all="$(scontrol -o show job)"
[ "$(grep -c JobState=COMPLETED <<<"$all")" = "$(wc -l <<<"$all")" ] || { echo "$all" && exit 1; }
grep -q "ArrayTaskId=$shard .*Restarts=[1-9]" <<<"$all"
grep -q "blocks: 1 of 16" "slurm-${job}_$shard.out"
grep -q " 16  of 16 blocks" "slurm-${job}_status.out"

# 5. The store of a single process is equal.
"$whiskmap" map "$here/sweep.toml" -o "$scratch/whole" --format zarr --engine cpu --channels regime,force_un >/dev/null
"$whiskmap" status "$shared/sweep.zarr" --verify
diff -r "$scratch/whole/sweep.zarr" "$shared/sweep.zarr"
echo "the store equals that of a single process"
