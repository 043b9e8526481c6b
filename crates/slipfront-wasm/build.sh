#!/usr/bin/env bash
# Builds the session of the laboratory as WebAssembly: target/slipfront.wasm, which `slipfront lab --export` and `--single` take.
#
#     crates/slipfront-wasm/build.sh
#
# Needs rustup, which adds the target wasm32-unknown-unknown where it is missing. Where wasm-opt of Binaryen is installed, the module becomes a
# seventh smaller, which takes a minute.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
target=wasm32-unknown-unknown
if ! rustup target list --installed | grep --quiet --line-regexp "$target"; then
    rustup target add "$target"
fi
# Vectors of two doubles: every browser has had them since 2023. A folder of its own, since the program is built with other flags. Paths are replaced,
# so that the module has the same bytes wherever it is built.
# \x1f stands between flags, since a path may contain a blank.
printf -v flags '%s\x1f' -C target-feature=+simd128 "--remap-path-prefix=$PWD=/slipfront" "--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=/cargo"
CARGO_ENCODED_RUSTFLAGS=${flags%$'\x1f'} cargo build --profile wasm --quiet --locked -p slipfront-wasm --lib --target "$target" --target-dir target/wasm
built=target/wasm/$target/wasm/slipfront_wasm.wasm
if command -v wasm-opt > /dev/null; then
    # What rustc takes for granted of every browser, and SIMD.
    features=(--enable-simd --enable-bulk-memory --enable-sign-ext --enable-mutable-globals --enable-nontrapping-float-to-int --enable-reference-types --enable-multivalue)
    wasm-opt "${features[@]}" -Oz "$built" -o target/slipfront.wasm
else
    cp "$built" target/slipfront.wasm
fi
printf 'target/slipfront.wasm has %d bytes\n' "$(stat --format=%s target/slipfront.wasm)"
