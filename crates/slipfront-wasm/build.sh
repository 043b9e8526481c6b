#!/usr/bin/env bash
# Builds the session of the laboratory as WebAssembly, target/slipfront.wasm, and the module that does the work
# beside it, target/slipfront-work.wasm. `slipfront lab --export` and `--single` take both.
#
#     crates/slipfront-wasm/build.sh
#
# Needs rustup, which adds the target wasm32-unknown-unknown where it is missing. Where wasm-opt of Binaryen
# is installed, the modules become a seventh smaller, which takes a minute.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
target=wasm32-unknown-unknown
if ! rustup target list --installed | grep --quiet --line-regexp "$target"; then
    rustup target add "$target"
fi
# Vectors of two doubles: every browser has had them since 2023. A folder of its own, since the program is
# built with other flags. Paths are replaced, so that the modules have the same bytes wherever they are built.
# \x1f stands between flags, since a path may contain a blank.
printf -v flags '%s\x1f' -C target-feature=+simd128 "--remap-path-prefix=$PWD=/slipfront" "--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=/cargo"
export CARGO_ENCODED_RUSTFLAGS=${flags%$'\x1f'}
# What rustc takes for granted of every browser, and SIMD.
features=(--enable-simd --enable-bulk-memory --enable-sign-ext --enable-mutable-globals --enable-nontrapping-float-to-int --enable-reference-types --enable-multivalue)
made=target/wasm/$target/wasm/slipfront_wasm.wasm

# Builds one module, with one feature of slipfront-wasm.
module() {
    cargo build --profile wasm --quiet --locked -p slipfront-wasm --lib --no-default-features --features "$2" --target "$target" --target-dir target/wasm
    if command -v wasm-opt > /dev/null; then
        wasm-opt "${features[@]}" -Oz "$made" -o "target/$1"
    else
        cp "$made" "target/$1"
    fi
    printf 'target/%s has %d bytes\n' "$1" "$(stat --format=%s "target/$1")"
}
module slipfront.wasm session
module slipfront-work.wasm work
