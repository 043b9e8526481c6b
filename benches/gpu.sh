#!/usr/bin/env bash
# Bits and times of the kernels for a GPU, beside one core and all cores of the machine: some minutes.
#
#     benches/gpu.sh
#
# Needs a driver of NVIDIA, and NVRTC or the PTX that crates/slipfront-gpu/ptx.py makes. To build on a machine
# without a GPU, run `benches/gpu.sh build`, and carry gpu_ensembles and gpu_large of target/release/examples
# and the test program that it names to the other.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
gpu=(-p slipfront-gpu --features cuda --release --locked)
cargo build "${gpu[@]}" --example gpu_ensembles --example gpu_large
cargo test "${gpu[@]}" --test gpu --no-run
[ "${1:-}" = build ] && exit
cargo test "${gpu[@]}" --test gpu
"${CARGO_TARGET_DIR:-target}/release/examples/gpu_ensembles"
"${CARGO_TARGET_DIR:-target}/release/examples/gpu_large"
