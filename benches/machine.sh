#!/usr/bin/env bash
# Measures this machine and writes its section of docs/performance.md.
#
#     benches/machine.sh [NAME]
#
# NAME is the title of the section, which is written anew where there is one of that name; without it, the
# name in /proc/cpuinfo is taken. The whole takes some twenty minutes, in which the machine should have
# nothing else to do: the section tells what share others took. Needs the Rust toolchain; gcc, Python 3 and
# LAMMPS for the other programs, Open MPI and libclang for ranks, valgrind for instruction counts. What is
# missing is said in the section and left away.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=benches/common.sh
source benches/common.sh

# Vector operations of eight numbers in a step of eight blocks, square root and division aside:
# docs/kernels.md counts them.
OPERATIONS=170
cores=$(nproc)
name=${1:-$(processor)}

rounds=3
work=$PWD/target/machine
rm -rf "$work"
mkdir -p "$work"
section=$work/section.md
own() { awk '{ print $14 + $15 + $16 + $17 }' "/proc/$$/stat"; }
# Least of the wall times of a command that is run some times, in seconds.
best_of() {
  local TIMEFORMAT=%R
  for ((round = 0; round < rounds; round++)); do
    rm -rf "$work/out"
    { time "$@" > "$work/stdout" 2> "$work/stderr" || { cat "$work/stderr" >&2; exit 1; } } 2>&1
  done | sort -n | head -1
}

cargo build --quiet --release --locked -p slipfront --example option_cost --example large_step
cargo build --quiet --release --locked -p slipfront-cli
slipfront=target/release/slipfront
examples=target/release/examples
all=$(busy) mine=$(own) began=$(date +%s)

say "$cores processors of this kind; $(rustc --version), $(uname -sm). Measured on $(date -u +%F) at $(git describe --always --dirty)." ""

if command -v gcc > /dev/null && { has avx || has avx512f; }; then
  gcc -std=gnu11 -O2 -march=native -o "$work/bound" benches/bound.c
  say "**Bound.** $("$work/bound" "$OPERATIONS" | paste -s -d ' ')" ""
else
  say "**Bound.** Not measured: it takes gcc, and a processor with AVX." ""
fi

say "**Beside other programs** (\`benches/peers/run.sh -r 3\`), nanoseconds per block and step, best of three rounds." ""
if benches/peers/run.sh -r 3 > "$work/peers" 2>&1; then
  awk -F ' *\\| *' -v OFS='\t' 'BEGIN { print "blocks", "program", "ns", "times slipfront" } $2 ~ /^[0-9]+ x/ && $6 != "-" { print $2, $3, $6, $8 }' "$work/peers" | table
  say ""
else
  say "Not measured: $(tail -1 "$work/peers")" ""
fi

say "**Options** (\`option_cost\`), every block at every step, best of 150 turns." ""
for threads in 1 $((cores > 1 ? 2 : 0)); do
  [ "$threads" -gt 0 ] || continue
  "$examples/option_cost" "$threads" 50 200 | awk -v threads="$threads" '
    / blocks, / { size = $1 " x " $3; next }
    { time = $(NF - 1); times = $NF; sub(/ +[0-9.]+ +[0-9.]+$/, ""); print threads "\t" size "\t" $0 "\t" time "\t" times }'
done > "$work/options"
awk -F '\t' -v OFS='\t' '
  { key = $2 ", " ($1 == 1 ? "one thread" : "two threads") }
  !(key in column) { column[key] = ++n; title[n] = key }
  !($3 in row) { row[$3] = ++rows; option[rows] = $3 }
  { ns[$3, column[key]] = $4; times[$3, column[key]] = $5 }
  END {
    head = "option"
    for (c = 1; c <= n; c++) head = head OFS title[c] ", ns" OFS "times plain"
    print head
    for (r = 1; r <= rows; r++) {
      line = option[r]
      for (c = 1; c <= n; c++) line = line OFS ns[option[r], c] OFS times[option[r], c]
      print line
    }
  }' "$work/options" | table
say ""

say "**Sizes and threads** (\`large_step\`), every block at every step, and the time to move the bytes that a step must." ""
{
  printf 'blocks\tthreads\tns per block and step\tns for its bytes\n'
  for size in 512 1024 4096; do
    for threads in 1 $((cores > 1 ? 2 : 0)); do
      [ "$threads" -gt 0 ] || continue
      "$examples/large_step" "$size" "$threads" |
        sed -nE 's/^(.*) blocks, (.*) threads: (.*) ns per block and step; its 80 bytes alone (.*) ns \(.*/\1\t\2\t\3\t\4/p'
    done
  done
} | table
say ""

say "**Whole commands**, wall time in seconds, best of three." ""
printf '[base.slider]\nblocks = [25, 25]\n[study]\nreplicates = 1000\n' > "$work/study.toml"
{
  printf 'command\tseconds\n'
  printf '`slipfront run`\t%s\n' "$(best_of "$slipfront" run --quiet -o "$work/out")"
  printf '`slipfront run --no-pictures`\t%s\n' "$(best_of "$slipfront" run --no-pictures --quiet -o "$work/out")"
  printf 'study of 1000 runs of the baseline\t%s\n' "$(best_of "$slipfront" study --quiet "$work/study.toml" -o "$work/out")"
  printf '`slipfront paper`, once\t%s\n' "$(rounds=1 best_of "$slipfront" paper --quiet -o "$work/out")"
} | table
say ""

say "**Ranks**, 2048 x 2048 blocks, 240 steps, whole commands, wall time in seconds, best of three." ""
if command -v mpirun > /dev/null && cargo build --quiet --release --locked --manifest-path crates/slipfront-mpi/Cargo.toml --target-dir target 2> "$work/mpi"; then
  cat > "$work/ranks.toml" << 'END'
[slider]
blocks = [2048, 2048]
[drive]
v_star = 0.2
[time]
duration_star = 24
[output]
snapshots = []
END
  ranks() { best_of mpirun --allow-run-as-root --oversubscribe -n "$1" target/release/slipfront-mpi run "$work/ranks.toml" --quiet -o "$work/out"; }
  {
    printf 'way\tseconds\n'
    printf 'one thread\t%s\n' "$(best_of "$slipfront" run "$work/ranks.toml" --threads 1 --quiet -o "$work/out")"
    printf 'two threads\t%s\n' "$(best_of "$slipfront" run "$work/ranks.toml" --threads 2 --quiet -o "$work/out")"
    printf 'one rank\t%s\n' "$(ranks 1)"
    printf 'two ranks\t%s\n' "$(ranks 2)"
  } | table
  say ""
else
  say "Not measured: they take Open MPI and libclang." ""
fi

say "**Instructions** (\`benches/instructions.sh\`), per block and step, with AVX2." ""
if command -v valgrind > /dev/null; then
  benches/instructions.sh | sed -nE 's/^([0-9]+ x .*): (.*)$/\1\t\2/p' | { printf 'blocks\tinstructions\n'; cat; } | table
  say ""
else
  say "Not measured: they take valgrind." ""
fi

say "$(awk -v hz="$(getconf CLK_TCK)" -v others="$(($(busy) - all - ($(own) - mine)))" -v seconds="$(($(date +%s) - began))" -v cores="$cores" \
  'BEGIN { printf "Others took %.0f %% of the processor time in these %.0f minutes.", 100 * others / hz / seconds / cores, seconds / 60 }')"
write_section "$name"
