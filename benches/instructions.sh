#!/usr/bin/env bash
# Instructions that a step executes, which do not depend on how busy the machine is.
#
#     benches/instructions.sh
#
# Counts, under valgrind's callgrind, the instructions of 2000 and of 1000 steps of the baseline of Fig. 3 and
# takes the difference: start and set-up fall out. Fails when a count is off by more than TOLERANCE from the
# one in benches/instructions.txt; `benches/instructions.sh --pin` writes that file anew. Another compiler
# gives other counts, so the file names the one it was pinned with, and with another one differences are told
# but not failed. Valgrind knows no AVX-512: what is counted is the AVX2 code.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# In percent: what a hash seed or a longer path in the environment may change is far below; a lost inlining is
# far above.
TOLERANCE=2
pins=benches/instructions.txt

cargo build --quiet --release --locked -p slipfront --example step_cost
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# shellcheck source=benches/common.sh
source benches/common.sh

instructions() { # SIZE STEPS FLAG...
  local size=$1 steps=$2
  shift 2
  valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    target/release/examples/step_cost "$size" "$work/s$size" "$work/k$size" "$steps" "$@" 2>&1 |
    awk '/Collected/ { print $4 }'
}

found=$work/found
rustc --version > "$found"
for size in 25 50; do
  surface "$size" 1 1 > "$work/s$size"
  surface "$size" 0.5 2 > "$work/k$size"
  for flag in "" --no-skip; do
    # shellcheck disable=SC2086 # No flag is no argument.
    more=$(instructions "$size" 2000 $flag) fewer=$(instructions "$size" 1000 $flag)
    echo "$size x $size${flag:+ $flag}: $(awk "BEGIN { printf \"%.2f\", ($more - $fewer) / (1000 * $size * $size) }")" >> "$found"
  done
done
echo "instructions per block and step:"
cat "$found"

if [[ ${1:-} == --pin ]]; then
  cp "$found" "$pins"
  exit
fi
paste -d '|' "$pins" "$found" | awk -F '|' -v tolerance="$TOLERANCE" '
  NR == 1 { same = $1 == $2; if (!same) print "pinned with " $1 ": differences are not failed"; next }
  {
    split($1, pinned, ": "); split($2, found, ": ")
    off = 100 * (found[2] / pinned[2] - 1)
    if (off > tolerance || off < -tolerance) { printf "%s is off by %+.1f %%\n", pinned[1], off; bad = 1 }
  }
  END { exit same && bad }'
