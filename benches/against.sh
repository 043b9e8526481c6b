#!/usr/bin/env bash
# Time of this checkout over that of another commit, by turns on this machine.
#
#     benches/against.sh [-r ROUNDS] [-c COMMIT] [WHAT...]
#
# WHAT: step, run, study, paper, family; the first three unless told. Each is made by both programs
# alternately, ROUNDS times, 5 unless told; the medians of the wall times, and the ratios of these, of the
# least wall times and of the processor times, are printed: where they differ by much, the machine was busy.
# COMMIT is the one in benches/against.txt unless told: the last before the work on speed that is under way.
# It is built in target/against. The machine should have nothing else to do.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=benches/common.sh
source benches/common.sh

rounds=5
commit=$(cat benches/against.txt)
while getopts r:c: option; do
  case $option in
    r) rounds=$OPTARG ;;
    c) commit=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
what=("$@")
[ $# -gt 0 ] || what=(step run study)

work=$PWD/target/against
mkdir -p "$work"
checkout=$work/checkout
rm -rf "$checkout"
mkdir "$checkout"
git archive "$commit" | tar -x -C "$checkout"
build() {
  cargo build --quiet --release --locked -p slipfront --example step_cost
  cargo build --quiet --release --locked -p slipfront-cli
}
build
(cd "$checkout" && CARGO_TARGET_DIR=$work/target build)
declare -A built=([before]=$work/target/release [now]=$PWD/target/release)

# One study of many short runs: 200 replicates of the baseline on 25 x 25 blocks.
printf '[base.slider]\nblocks = [25, 25]\n[study]\nreplicates = 200\n' > "$work/study.toml"
for size in 25 50 200; do
  surface "$size" 1 1 > "$work/s$size"
  surface "$size" 0.5 2 > "$work/k$size"
done

# Wall time and processor time of a command, in seconds.
seconds() { # NAME WHICH COMMAND...
  local name=$1 which=$2 out=$work/out TIMEFORMAT='%R %U %S'
  shift 2
  rm -rf "$out"
  { time "$@" > /dev/null 2> "$work/errors" || { cat "$work/errors" >&2; exit 1; } } 2> "$work/time"
  awk -v name="$name" -v which="$which" '{ print name "\t" which "\t" $1 "\t" $2 + $3 }' "$work/time" >> "$work/times"
}
one_round() { # WHICH
  local slipfront=${built[$1]}/slipfront step=${built[$1]}/examples/step_cost one
  for one in "${what[@]}"; do
    case $one in
      step)
        for size in 25 50 200; do
          # Of the baseline, as often as gives all sizes the same time.
          local steps=$((2667 * 40000 / size / size))
          seconds "step, $size x $size" "$1" "$step" "$size" "$work/s$size" "$work/k$size" $steps
          seconds "step, $size x $size, every block" "$1" "$step" "$size" "$work/s$size" "$work/k$size" $steps --no-skip
        done ;;
      run) seconds run "$1" "$slipfront" run cases/baseline.toml --quiet -o "$work/out" ;;
      study) seconds study "$1" "$slipfront" study "$work/study.toml" --quiet -o "$work/out" ;;
      paper) seconds paper "$1" "$slipfront" paper --quiet -o "$work/out" ;;
      family) seconds family "$1" "$slipfront" family --docs "$work/out" ;;
      *) echo "'$one' is none of step, run, study, paper, family" >&2; exit 2 ;;
    esac
  done
}

: > "$work/times"
for ((round = 0; round < rounds; round++)); do
  one_round before
  one_round now
done
echo "medians of $rounds rounds, $commit and $(git describe --always --dirty), in seconds"
python3 - "$work/times" << 'END'
import collections, statistics, sys
found = collections.defaultdict(lambda: collections.defaultdict(list))
for line in open(sys.argv[1]):
    name, which, wall, processor = line.rstrip("\n").split("\t")
    found[name][which].append((float(wall), float(processor)))
print("| | before | now | ratio | of the least | of processor times |\n|---|---|---|---|---|---|")
for name, times in found.items():
    of = lambda statistic, k: [statistic(t[k] for t in times[which]) for which in ("before", "now")]
    wall, least, processor = of(statistics.median, 0), of(min, 0), of(statistics.median, 1)
    ratios = " | ".join(f"{now / before:.2f}" for before, now in (wall, least, processor))
    print(f"| {name} | {wall[0]:.3f} | {wall[1]:.3f} | {ratios} |")
END
