#!/bin/bash
# Runs a study, a long run and a run on several ranks on a real Slurm: a cluster of this one machine, started
# in a temporary folder and ended with it.
#
# Needs Debian's slurm-wlm (slurmctld, slurmd, sbatch, scontrol) and munge, and root; it installs nothing.
# slipfront-mpi is taken from the folder of slipfront:
#
#     apt-get install slurm-wlm munge libopenmpi-dev openmpi-bin libclang-dev
#     cargo build --release
#     cargo build --release --manifest-path crates/slipfront-mpi/Cargo.toml --target-dir target
#     tests/slurm/run.sh [path of slipfront]
#
# A study is submitted with the script of `slipfront study slurm`, in three tasks. One task is requeued in the
# middle, the command of another is killed, and that task is submitted again. The merged parts must be the
# same bytes as the study run without Slurm, and no run may have been made twice. Then the script of
# docs/guide/long.md runs a case whose job gets SIGTERM twice: it puts itself back into the queue, and writes
# the same bytes as without. So does the second script of that page, with the ranks started by
# `srun --mpi=pmix`; a rank that is killed ends its job, which goes on when it is submitted again. Takes five
# to eight minutes on two busy cores. Not part of the tests that always run: no continuous integration has
# Slurm.

set -euo pipefail

here=$(realpath "$(dirname "$0")")
slipfront=$(realpath "${1:-$here/../../target/release/slipfront}")
[ -x "$slipfront-mpi" ] || { echo "needs $slipfront-mpi: see the head of $0"; exit 2; }
for command in slurmctld slurmd sbatch squeue scontrol munged mungekey; do
  PATH=$PATH:/usr/sbin command -v "$command" > /dev/null || { echo "needs $command: apt-get install slurm-wlm munge"; exit 2; }
done
[ "$(id -u)" = 0 ] || { echo "needs root: slurmd starts jobs as their users"; exit 2; }
export PATH=$PATH:/usr/sbin

work=$(mktemp -d /tmp/slipfront-slurm.XXXXXX)
chmod 755 "$work"
host=$(hostname -s)
started=()

finish() {
  status=$?
  set +e
  scancel --name=study 2> /dev/null
  scancel --name=long 2> /dev/null
  for ((k = ${#started[@]} - 1; k >= 0; k--)); do kill "${started[k]}" 2> /dev/null; done
  wait 2> /dev/null
  if [ $status = 0 ]; then rm -rf "$work"; else echo "failed: logs are in $work"; fi
  exit $status
}
trap finish EXIT

# --- A cluster of one node.

mkdir -p "$work"/{state,spool}
mungekey --create --keyfile="$work/munge.key" 2> /dev/null || dd if=/dev/urandom of="$work/munge.key" bs=1k count=1 status=none
chmod 400 "$work/munge.key"
munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
  --seed-file="$work/munge.seed" --log-file="$work/munged.log" > "$work/munged.out" 2>&1 &
started+=($!)

cat > "$work/slurm.conf" << END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$work/munge.socket
SlurmctldPort=26817
SlurmdPort=26818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SchedulerType=sched/backfill
MpiDefault=none
ReturnToService=2
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$work/slurm.conf

for _ in $(seq 50); do [ -S "$work/munge.socket" ] && break; sleep 0.1; done
slurmctld -D -f "$SLURM_CONF" > "$work/slurmctld.out" 2>&1 &
started+=($!)
slurmd -D -f "$SLURM_CONF" > "$work/slurmd.out" 2>&1 &
started+=($!)
for _ in $(seq 100); do sinfo -h -o %T 2> /dev/null | grep -q idle && break; sleep 0.2; done
sinfo

# --- The study without Slurm, and its script.

cd "$work"
cat > study.toml << 'END'
[base.slider]
blocks = [30, 30]
[[base.texture]]
shape = "cavity"
coverage = 10
[study]
replicates = 10
reference = { texture = [] }
[[axes]]
key = "drive.v_star"
list = [0.02, 0.03, 0.04]
[[axes]]
key = "friction.r_star"
list = [0.4, 0.5, 0.6]
END
"$slipfront" study study.toml --quiet -o whole
"$slipfront" study slurm study.toml --tasks 3 -o out > study.sbatch
runs=$(wc -l < whole/runs.jsonl)
echo "$runs runs without Slurm"

# --- Submitted, requeued and killed.

recorded() { if [ -f "$1/runs.jsonl" ]; then wc -l < "$1/runs.jsonl"; else echo 0; fi; }
wait_for() { # until a part has more than so many records
  for _ in $(seq 600); do
    if [ "$(recorded "out/shard-$1")" -gt "$2" ]; then return; fi
    sleep 0.05
  done
  echo "part $1 does not go on"; squeue; exit 1
}
state() { squeue -h -j "$1" -o %T 2> /dev/null | sort | uniq -c | tr '\n' ' '; }
wait_end() {
  for _ in $(seq 600); do
    [ -z "$(squeue -h -j "$1" -o %i 2> /dev/null)" ] && return
    # A requeued task waits two minutes by default; not here.
    squeue -h -j "$1" -t PENDING -o '%i %r' 2> /dev/null | awk '$2 == "BeginTime" { print $1 }' |
      while read -r task; do scontrol update JobId="$task" StartTime=now; done
    sleep 0.5
  done
  echo "the job does not end"; squeue; exit 1
}

job=$(sbatch --parsable study.sbatch)
echo "submitted as job $job"
wait_for 1 5
scontrol requeue "${job}_1"
echo "requeued task 1 with $(recorded out/shard-1) of its runs recorded"
wait_for 2 5
kill -9 "$(pgrep -f "^$slipfront study .*$work/out/shard-2 " | head -1)"
echo "killed the command of task 2 with $(recorded out/shard-2) of its runs recorded"
wait_end "$job"
echo "after the job: $(recorded out/shard-1), $(recorded out/shard-2), $(recorded out/shard-3) runs"
grep -h -i "requeue\|cancelled\|stopped" slurm-study-1.log || true

again=$(sbatch --parsable --array=2 study.sbatch)
echo "task 2 submitted again as job $again"
wait_end "$again"

# --- One study.

"$slipfront" study merge out/shard-* --out out/merged --quiet
for file in whole/*.csv whole/*.svg whole/*.png; do
  cmp "$file" "out/merged/$(basename "$file")"
done
merged=$(cut -c 18- out/merged/runs.jsonl | sort | uniq | wc -l)
parts=$(cat out/shard-*/runs.jsonl | wc -l)
echo "$parts runs in three parts, $merged merged"
[ "$parts" = "$runs" ] && [ "$merged" = "$runs" ]
echo "passed: tables and pictures are the same bytes, and no run was made twice"

# --- Long runs, by the scripts of the guide.

cat > case.toml << 'END'
[slider]
blocks = [250, 250]
[drive]
v_star = 0.005
END
"$slipfront" run case.toml --quiet -o once
PATH=$(dirname "$slipfront"):$PATH

# Writes a script of the guide as NAME.sh, its first or its second. This machine has fewer processors than the
# one the guide has in mind.
script() { # NAME NUMBER
  awk -v wanted="$2" '/^```/ { inside = /^```sh/; found += inside; next } inside && found == wanted' "$here/../../docs/guide/long.md" |
    sed "s/per-task=16/per-task=$(nproc)/; /--mem/d; s/--nodes=.*/--nodes=1/; s/per-node=.*/per-node=$ranks/" > "$1.sh"
  if [ "$ranks" -gt "$(nproc)" ]; then sed -i 's/^#SBATCH --nodes.*/&\n#SBATCH --overcommit/' "$1.sh"; fi
}
submit() { sbatch --parsable --job-name=long --open-mode=append --output="$1.log" "$1.sh"; }
processes() { pgrep -f "^[^ ]*slipfront(-mpi)? run .*results/job-$1"; }
wait_for_run() { # until the command of a job goes through its steps
  for _ in $(seq 600); do
    [ -e "results/job-$1/case.toml" ] && processes "$1" > /dev/null && break
    # A requeued job waits two minutes by default; here, until its last step has gone.
    pgrep -f "^slurmstepd: \\[$1\\.[0-9]" > /dev/null ||
      squeue -h -j "$1" -t PENDING -o '%i %r' | awk '$2 == "BeginTime" { print $1 }' |
      while read -r task; do scontrol update JobId="$task" StartTime=now; done
    sleep 0.1
  done
  sleep 0.7
}
stop_twice() { # NAME JOB
  for stop in 1 2; do
    wait_for_run "$2"
    scancel --signal=TERM "$2"
    for _ in $(seq 600); do
      [ "$(grep -c 'stopped by a signal' "$1.log")" -ge "$stop" ] && ! processes "$2" > /dev/null && break
      sleep 0.05
    done
  done
  wait_end "$2"
  grep 'stopped by a signal' "$1.log"
  [ "$(grep -c 'stopped by a signal' "$1.log")" = 2 ]
}
same_as_once() { # FOLDER
  for file in once/*; do
    [ "$file" = once/manifest.json ] || cmp "$file" "$1/$(basename "$file")"
  done
}

ranks=2
script long 1
job=$(submit long)
stop_twice long "$job"
same_as_once "results/job-$job"
echo "passed: a job that was stopped twice wrote the same bytes"

script mpi 2
job=$(submit mpi)
stop_twice mpi "$job"
same_as_once "results/job-$job"
echo "passed: so did a job of $ranks ranks"

job=$(submit mpi)
wait_for_run "$job"
kill -9 "$(processes "$job" | tail -1)"
wait_end "$job"
[ ! -e "results/job-$job/manifest.json" ]
scontrol show job "$job" | grep -q 'ExitCode=137:0'
srun --mpi=pmix --overcommit -n "$ranks" slipfront-mpi run --quiet --resume "results/job-$job"
same_as_once "results/job-$job"
echo "passed: the end of one rank was the end of its job, and another went on with it"
