#!/usr/bin/env bash
# Bits and times of the kernels for a GPU, beside one core and all cores of the machine: some minutes.
#
#     benches/gpu.sh                builds, and measures
#     benches/gpu.sh build DIR      builds the programs into a folder, on any machine
#     benches/gpu.sh measure DIR    measures with the programs in a folder, on a machine with a GPU
#
# To build needs cargo, and Python with venv for the kernels. To measure needs a driver of NVIDIA alone. With
# DEVICE=cpu the parts after the kernels run on the CPU in place of the GPU, to try the script.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
step=${1:-all}
dir=${2:-${CARGO_TARGET_DIR:-target}/gpu}
device=${DEVICE:-gpu}

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
}

# Seconds of a command, which says nothing.
seconds() {
    local begun=$EPOCHREALTIME
    "$@" > /dev/null
    awk -v from="$begun" -v to="$EPOCHREALTIME" 'BEGIN { printf "%.2f", to - from }'
}

# The same files by the GPU as by all cores, and the seconds of both: NAME, FILES, COMMAND that is given a
# folder.
compare() {
    local name=$1 files=$2 on_gpu on_cpu file
    shift 2
    on_gpu=$(seconds "$@" -o "$work/gpu" --device "$device" --quiet)
    on_cpu=$(seconds "$@" -o "$work/cpu" --quiet)
    for file in $files; do
        cmp "$work/gpu/$file" "$work/cpu/$file"
    done
    printf '%s   %s %s s   %d cores %s s   same bytes\n' "$name" "$device" "$on_gpu" "$(nproc)" "$on_cpu"
    rm -r "$work/gpu" "$work/cpu"
}

measure() {
    local slipfront=$dir/slipfront surfaces=${SURFACES:-100000} size=${SIZE:-4096}
    if [ "$device" = gpu ]; then
        "$dir/same_bits"
        "$dir/gpu_ensembles"
        "$dir/gpu_large"
    fi
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    printf 'base = { drive = { v_star = 0.03 }, time = { stop = "after_onset" } }\n[study]\nreplicates = %d\n' "$surfaces" > "$work/study.toml"
    compare "study of $surfaces surfaces of 25 x 25 blocks" points.csv "$slipfront" study "$work/study.toml" --yes
    compare 'calibration from a record' calibration.json "$slipfront" calibrate cases/calibrations/sliding.toml cases/calibrations/sliding.csv
    printf 'slider.blocks = [%d, %d]\ndrive.v_star = 0.1\ntime = { duration_star = 100, stop = "after_onset" }\noutput.stride = 16\n' "$size" "$size" > "$work/large.toml"
    compare "onset of $size x $size blocks" 'summary.json series.csv fields.nc' "$slipfront" run "$work/large.toml" --no-pictures
}

case $step in
    all) build && measure ;;
    build | measure) "$step" ;;
    *) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2 && exit 2 ;;
esac
