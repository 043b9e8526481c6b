#!/usr/bin/env bash
# libFuzzer on the parsers: tests/fuzz/run.sh [SECONDS [TARGET ...]], by default 60 s of processor time on
# every target.
#
# Needs a C++ compiler, and no nightly Rust: the coverage that libFuzzer steers by is a pass of the stable
# compiler. What it finds stands in target/fuzz/artifacts/TARGET; what it has learned, in
# target/fuzz/corpus/TARGET, is gone on from. A line for every slice is added to target/fuzz/log.csv. JOBS=2
# runs two slices at a time, SLICE is the longest. 0 seconds build everything and run nothing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

wanted="${1:-60}"
shift || true
slice="${SLICE:-240}"
jobs="${JOBS:-1}"
out=target/fuzz
mkdir -p "$out"

host="$(rustc -vV | sed -n 's/^host: //p')"
revision="$(git rev-parse --short HEAD 2> /dev/null || echo none)"
cargo build --quiet --locked --package slipfront-fuzz --bin fuzz-seeds
target/debug/fuzz-seeds "$out/seeds" > "$out/targets"
if [ "$#" -eq 0 ]; then
    set -- $(cut -d ' ' -f 1 "$out/targets")
fi
export RUSTFLAGS="-Ccodegen-units=1 -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-sanitizer-coverage-trace-compares"
# Named, so that build scripts are not instrumented.
cargo build --quiet --locked --package slipfront-fuzz --features libfuzzer --bin fuzz --profile fuzz \
    --target-dir "$out/build" --target "$host"
fuzz="$out/fuzz-$revision-$$"
cp "$out/build/$host/fuzz/fuzz" "$fuzz"

# Parsers read files: in memory, where there is room for them.
if [ -w /dev/shm ]; then
    TMPDIR="$(mktemp --directory --tmpdir=/dev/shm)"
else
    TMPDIR="$(mktemp --directory)"
fi
export TMPDIR
cpu_times="$TMPDIR/cpu"
mkdir "$cpu_times"
trap 'rm -rf "$TMPDIR" "$fuzz"' EXIT

log="$out/log.csv"
[ -e "$log" ] || echo 'finished,revision,target,cpu_s,executions,edges,features,corpus,peak_rss_mb,finding' > "$log"

# One slice of a target: run_slice TARGET SECONDS.
run_slice() {
    local name="$1" seconds="$2" longest said status=0 cpu
    read -r _ longest < <(grep "^$name " "$out/targets")
    mkdir -p "$out/corpus/$name" "$out/artifacts/$name"
    said="$out/last-$name.txt"
    local options=(-max_total_time="$seconds" -max_len="$longest" -timeout=60 -rss_limit_mb=2048 -print_final_stats=1
        -artifact_prefix="$out/artifacts/$name/")
    [ ! -s "$out/seeds/$name.dict" ] || options+=(-dict="$out/seeds/$name.dict")
    TIMEFORMAT='%U %S'
    { time SLIPFRONT_FUZZ="$name" "$fuzz" "${options[@]}" "$out/corpus/$name" "$out/seeds/$name" > "$said" 2>&1; } \
        2> "$cpu_times/$name-time" || status=$?
    # Of a process that a signal has ended, the shell tells that first.
    cpu="$(tail -n 1 "$cpu_times/$name-time" | awk '{ printf "%.0f", $1 + $2 }')"
    echo "$cpu" >> "$cpu_times/$name"
    local stat finding=
    stat() { sed -n "s/^stat::$1: *//p" "$said" | tail -n 1; }
    [ "$status" -eq 0 ] || finding="$(sed -n 's/.*Test unit written to //p' "$said" | tail -n 1)"
    # A stack that overflows ends the process before it can write anything: such a target keeps its input
    # itself.
    local input
    # Its folder has a hidden name.
    input="$(find "$TMPDIR" -name "$name-input" -printf '%T@ %p\n' | sort -n | tail -n 1 | cut -d ' ' -f 2-)"
    if [ "$status" -ne 0 ] && [ -z "$finding" ] && [ -n "$input" ]; then
        finding="$out/artifacts/$name/abort-$(sha1sum "$input" | cut -d ' ' -f 1)"
        cp "$input" "$finding"
    fi
    [ "$status" -eq 0 ] || [ -n "$finding" ] || finding="status $status"
    local last
    last="$(grep -E ' cov: [0-9]+ ft: ' "$said" | tail -n 1 || true)"
    echo "$(date --utc +%FT%TZ),$revision,$name,$cpu,$(stat number_of_executed_units),$(
        sed 's/.* cov: \([0-9]*\) .*/\1/' <<< "$last"),$(sed 's/.* ft: \([0-9]*\) .*/\1/' <<< "$last"),$(
        sed 's/.* corp: \([0-9]*\)\/.*/\1/' <<< "$last"),$(stat peak_rss_mb),$finding" >> "$log"
    if [ "$status" -ne 0 ]; then
        echo "$name: $finding"
        cp "$said" "$out/artifacts/$name.txt"
    fi
}

# Whoever had the least time goes next, until all have had theirs; what has failed is not tried again.
spent() { touch "$cpu_times/$1" && awk '{ sum += $1 } END { printf "%.0f", sum }' "$cpu_times/$1"; }
next() {
    local name least= chosen=
    for name in "$@"; do
        [ -e "$cpu_times/$name-busy" ] && continue
        grep -q "^$name:" "$cpu_times/failed" 2> /dev/null && continue
        local had
        had="$(spent "$name")"
        [ "$had" -lt "$wanted" ] || continue
        if [ -z "$least" ] || [ "$had" -lt "$least" ]; then
            least="$had"
            chosen="$name"
        fi
    done
    echo "$chosen $least"
}
while true; do
    read -r name had < <(next "$@")
    if [ -z "$name" ]; then
        # Somebody may still be at it who will need another slice.
        [ "$(jobs -rp | wc -l)" -gt 0 ] || break
        wait -n || true
        continue
    fi
    touch "$cpu_times/$name-busy"
    seconds=$((wanted - had < slice ? wanted - had : slice))
    {
        run_slice "$name" "$seconds" | tee -a "$cpu_times/failed"
        rm "$cpu_times/$name-busy"
    } &
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do
        wait -n || true
    done
done
# Sums over all runs that the log tells of.
awk -F, 'NR > 1 { cpu[$3] += $4; runs[$3] += $5; edges[$3] = $6; found[$3] += $10 != "" }
    END { for (name in cpu) printf "%-12s %6.1f min of processor time, %10d executions, %5d edges, %d findings\n",
        name, cpu[name] / 60, runs[name], edges[name], found[name] }' "$log" | sort
[ ! -s "$cpu_times/failed" ]
