#!/bin/bash
# Runs per second of a study on two threads against one.
#
#     cargo build --release
#     benches/study_threads.sh [path of slipfront]
#
# A study of 1000 equal runs (30 x 30 blocks, V* = 0.1, some 6 ms each) is run from nothing, by turns with
# --threads 1 and --threads 2, five times each: whole commands, from reading the file to the tables. The ratio
# of the best times is the answer; at least 1.9 is asked for. It only means something on two free cores, so
# the script says how busy the machine was: the share of processor time that others took while it ran.

set -euo pipefail
export LC_ALL=C
# shellcheck source=benches/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

slipfront=$(realpath "${1:-$(dirname "$0")/../target/release/slipfront}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat > study.toml << 'END'
[base.slider]
blocks = [30, 30]
[base.drive]
v_star = 0.1
[study]
replicates = 1000
END

seconds() { # of one study, and of the processor time it took
  rm -rf out
  local TIMEFORMAT='%R %U %S'
  { time "$slipfront" study study.toml --quiet --threads "$1" -o out; } 2>&1
}

before=$(busy)
began=$(date +%s.%N)
own=0
for _ in 1 2 3 4 5; do
  for threads in 1 2; do
    read -r real user system <<< "$(seconds "$threads")"
    echo "$threads $real" >> times
    own=$(awk "BEGIN { print $own + $user + $system }")
  done
done
ended=$(date +%s.%N)
after=$(busy)

awk '{ t = $2; if (!($1 in best) || t < best[$1]) best[$1] = t; all[$1] = all[$1] " " t }
     END { for (n = 1; n <= 2; n++) printf "%d threads: best %.3f s, %.1f runs/s; all:%s\n", n, best[n], 1000 / best[n], all[n]
           printf "ratio of the best: %.3f\n", best[1] / best[2] }' times
awk -v ticks="$(getconf CLK_TCK)" -v cores="$(nproc)" -v b="$before" -v a="$after" -v own="$own" -v t0="$began" -v t1="$ended" \
  'BEGIN { printf "others took %.0f %% of the processor time of %d cores\n", 100 * ((a - b) / ticks - own) / ((t1 - t0) * cores), cores }'
