#!/usr/bin/env bash
# Bits and times of the kernels for a GPU, beside one core and all cores of the machine: some minutes.
#
#     benches/gpu.sh                builds, measures, and writes the section of docs/performance.md
#     benches/gpu.sh build DIR      builds the programs into a folder, on any machine
#     benches/gpu.sh measure DIR    measures with the programs in a folder, on a machine with a GPU
#     benches/gpu.sh write DIR      writes what was measured into docs/performance.md
#
# To build needs cargo, and Python with venv for the kernels. To measure needs a driver of NVIDIA alone. With
# DEVICE=cpu the parts after the kernels run on the CPU in place of the GPU, to try the script.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source=benches/common.sh
source benches/common.sh
step=${1:-all}
dir=${2:-${CARGO_TARGET_DIR:-target}/gpu}
device=${DEVICE:-gpu}
section=$dir/section.md

build() {
    crates/slipfront-gpu/ptx.py
    local target=${CARGO_TARGET_DIR:-target}/release gpu=(-p slipfront-gpu --features cuda --release --locked)
    mkdir -p "$dir"
    cargo build "${gpu[@]}" --example gpu_ensembles --example gpu_large
    cargo build --release --locked -p slipfront-cli --features gpu
    cp "$target/examples/gpu_ensembles" "$target/examples/gpu_large" "$target/slipfront" "$dir"
    local test
    test=$(cargo test "${gpu[@]}" --test gpu --no-run 2>&1 | sed -n 's/.*Executable.*(\(.*\))$/\1/p')
    cp "$test" "$dir/same_bits"
    echo "$(git describe --always --dirty), $(rustc --version)" > "$dir/built_from"
}

# Seconds of a command, which says nothing.
seconds() {
    local begun=$EPOCHREALTIME
    "$@" > /dev/null
    awk -v from="$begun" -v to="$EPOCHREALTIME" 'BEGIN { printf "%.2f", to - from }'
}

# The same files by the GPU as by all cores, and the seconds of both, as a row: NAME, FILES, COMMAND that is
# given a folder.
compare() {
    local name=$1 files=$2 on_gpu on_cpu file
    shift 2
    on_gpu=$(seconds "$@" -o "$work/gpu" --device "$device" --quiet)
    on_cpu=$(seconds "$@" -o "$work/cpu" --quiet)
    for file in $files; do
        cmp "$work/gpu/$file" "$work/cpu/$file" >&2
    done
    printf '%s\t%s\t%s\tyes\n' "$name" "$on_gpu" "$on_cpu"
    rm -r "$work/gpu" "$work/cpu"
}

commands() {
    local slipfront=$dir/slipfront surfaces=${SURFACES:-100000} size=${SIZE:-4096}
    printf 'base = { drive = { v_star = 0.03 }, time = { stop = "after_onset" } }\n[study]\nreplicates = %d\n' "$surfaces" > "$work/study.toml"
    printf 'slider.blocks = [%d, %d]\ndrive.v_star = 0.1\ntime = { duration_star = 100, stop = "after_onset" }\noutput.stride = 16\n' "$size" "$size" > "$work/large.toml"
    printf 'command\t%s, s\tall cores, s\tsame bytes\n' "$device"
    compare "study of $surfaces surfaces of 25 x 25 blocks" points.csv "$slipfront" study "$work/study.toml" --yes
    compare 'calibration from a record' calibration.json "$slipfront" calibrate cases/calibrations/sliding.toml cases/calibrations/sliding.csv
    compare "onset of $size x $size blocks" 'summary.json series.csv fields.nc' "$slipfront" run "$work/large.toml" --no-pictures
}

# Goals beside what is in the tables of $work.
goals() {
    awk -F '\t' -v OFS='\t' '
        function row(goal, measured, is_met) { print goal, measured, is_met ? "yes" : "no" }
        BEGIN { print "goal", "measured", "met" }
        FILENAME ~ /ensembles$/ && $1 ~ /^(25|50) x/ { row("the speed of at least 150 cores on ensembles of " $1 " blocks", $5, $5 >= 150) }
        FILENAME ~ /large$/ && FNR > 1 { size = $1; share = $4 }
        FILENAME ~ /commands$/ && $1 ~ /^study/ { study = $1; seconds = $2 }
        END {
            row("at least 0.6 of the bandwidth of a copy on " size " blocks", share, share >= 0.6)
            row(study " within 10 s", seconds " s", seconds <= 10)
        }' "$work/ensembles" "$work/large" "$work/commands"
}

measure() {
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    : > "$section"
    rm -f "$dir/name"
    say "$(nproc) processors, $(processor); $(cat "$dir/built_from"), $(uname -sm). Measured on $(date -u +%F)." ""
    if [ "$device" = gpu ]; then
        "$dir/same_bits" >&2
        "$dir/gpu_ensembles" > "$work/ensembles"
        say "**Ensembles** (\`gpu_ensembles\`), 1000 steps, runs a second." ""
        table < "$work/ensembles"
        "$dir/gpu_large" > "$work/printed"
        tail -n +2 "$work/printed" > "$work/large"
        say "" "**Large lattices** (\`gpu_large\`), every block at every step, nanoseconds per block and step. $(head -1 "$work/printed")." ""
        table < "$work/large"
        if grep -w NO "$work/ensembles" "$work/large" >&2; then
            echo 'these lattices have other bits on the GPU' >&2
            exit 1
        fi
    fi
    commands > "$work/commands"
    say "" "**Whole commands** (\`benches/gpu.sh\`), wall time." ""
    table < "$work/commands"
    if [ "$device" = gpu ]; then
        say "" "**Goals**" ""
        goals | table
        sed -n '1s/ copies .*//p' "$work/printed" > "$dir/name"
    fi
    cat "$section"
}

write() {
    if [ ! -s "$dir/name" ]; then
        echo "docs/performance.md is not written: $dir has no whole measurement of a GPU" >&2
        exit 1
    fi
    write_section "$(cat "$dir/name")"
    echo 'its part "On a GPU" has goals that were not measured until now'
}

case $step in
    all)
        build
        measure
        write
        ;;
    build | measure | write) "$step" ;;
    *) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
