#!/usr/bin/env bash
# Makes what a release hands out, in target/dist/:
#
#     release/build.sh              everything
#     release/build.sh STEP...      the steps that are named
#
# linux-x86_64, linux-aarch64    the command, static (musl), with the page's module, licences and cases
# windows-x86_64                 the command
# lab                            the laboratory without a server, as a folder and as one file
# source                         the sources of this commit, and the source distribution for pip
# wheel-linux-x86_64, wheel-linux-aarch64, wheel-musl-x86_64, wheel-musl-aarch64, wheel-windows-x86_64
# check                          fails if a file in target/dist/ lacks a part, or a program in it asks for a
#                                library that not every machine has
# reproducible                   linux-x86_64 again, in a clone elsewhere: fails if a byte differs
#
# Needs Linux on x86-64, git, rustup, binutils, and python3 with venv. Installs Rust's targets, maturin, zig,
# NVRTC and a checker of SBOMs in target/, and mingw-w64 by apt-get for Windows. Each build of the command takes 4
# minutes of processor time.
set -euo pipefail
exec < /dev/null
cd "$(dirname "${BASH_SOURCE[0]}")/.."

version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml)
out=$PWD/target/dist
stage=$PWD/target/dist-stage
tools=$PWD/target/dist-tools
# Times of files in archives and wheels.
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
# Paths of this machine are replaced by others, so that they are no part of what is built. The flags of
# .cargo/config.toml, which these replace, are repeated.
flags=$(sed -n 's/^rustflags = \["\(.*\)"\]$/\1/p' .cargo/config.toml)
paths=("$PWD=/slipfront" "${CARGO_HOME:-$HOME/.cargo}=/cargo" "$(rustc --print sysroot)=/rust")
for path in "${paths[@]}"; do
    flags+=$'\x1f'"--remap-path-prefix=$path"
done
export CARGO_ENCODED_RUSTFLAGS=$flags CARGO_TARGET_DIR=$PWD/target/dist-build

say() {
    printf '\n== %d s: %s\n' "$SECONDS" "$*"
}

add_target() {
    rustup target list --installed | grep --quiet --line-regexp "$1" || rustup target add "$1"
}

# Python's tools, of the versions in release/requirements.txt.
venv() {
    cmp --silent release/requirements.txt "$tools/made" && return
    python3 -m venv --clear "$tools"
    "$tools/bin/pip" install --quiet --disable-pip-version-check --requirement release/requirements.txt
    cp release/requirements.txt "$tools/made"
}

# The laboratory as WebAssembly, two modules, which every command and wheel carries.
module() {
    [ -n "${module_made:-}" ] || env --unset=CARGO_ENCODED_RUSTFLAGS --unset=CARGO_TARGET_DIR crates/slipfront-wasm/build.sh
    module_made=yes
}

# Makes the PTX of the kernels, and adds the feature `gpu` to a command: where the driver of a GPU can be
# loaded, on Windows and on Linux with glibc.
with_kernels() {
    crates/slipfront-gpu/ptx.py
    "$@" --features gpu
}

# An archive with the command for a platform: NAME TARGET PROGRAM ARCHIVE, and options of cargo.
command_for() {
    local name=slipfront-$version-$1 target=$2 program=$3 archive=$4
    shift 4
    add_target "$target"
    module
    # The linker of Rust's own toolchain is the same on every machine, and knows every architecture.
    CARGO_TARGET_X86_64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld CARGO_TARGET_AARCH64_UNKNOWN_LINUX_MUSL_LINKER=rust-lld \
        cargo build --profile dist --locked --package slipfront-cli --target "$target" "$@"
    rm -rf "${stage:?}/$name"
    mkdir -p "$stage/$name"
    cp "$CARGO_TARGET_DIR/$target/dist/$program" target/slipfront.wasm target/slipfront-work.wasm LICENSE-APACHE LICENSE-MIT "$stage/$name"
    cp -r cases "$stage/$name"
    python3 -B tests/licences/notices.py --package crates/slipfront-cli --target "$target" --output "$stage/$name/THIRD-PARTY-NOTICES.txt"
    sbom crates/slipfront-cli "$target" "$stage/$name/slipfront.cdx.json"
    cp "$stage/$name/slipfront.cdx.json" "$out/$name.cdx.json"
    pack "$name" "$archive"
}

# A list of the crates in a program, as CycloneDX, held against its schema: PACKAGE TARGET FILE.
sbom() {
    venv
    "$tools/bin/python" -B release/sbom.py "$@"
}

# Packs a staged folder: NAME ENDING.
pack() {
    python3 -B release/pack.py "$stage/$1" "$out/$1.$2"
}

# A wheel: TARGET and options of maturin.
wheel() {
    local target=$1
    shift
    add_target "$target"
    venv
    module
    cp target/slipfront{,-work}.wasm python/slipfront/
    PATH=$tools/bin:$PATH "$tools/bin/maturin" build --profile dist --locked --target "$target" "$@" --manifest-path python/Cargo.toml --out "$out"
}

mingw() {
    command -v x86_64-w64-mingw32-gcc > /dev/null || apt-get install --yes --quiet gcc-mingw-w64-x86-64
    # Else the linker writes the time of the build into the program.
    export CARGO_ENCODED_RUSTFLAGS=$flags$'\x1f-Clink-arg=-Wl,--no-insert-timestamp'
}

step() {
    say "$1"
    # An if, since the flags of one step must not reach the next.
    if [ "$1" = linux-x86_64 ]; then
        command_for linux-x86_64 x86_64-unknown-linux-musl slipfront tar.gz
    elif [ "$1" = linux-aarch64 ]; then
        command_for linux-aarch64 aarch64-unknown-linux-musl slipfront tar.gz
    elif [ "$1" = windows-x86_64 ]; then
        (mingw && with_kernels command_for windows-x86_64 x86_64-pc-windows-gnu slipfront.exe zip)
    elif [ "$1" = lab ]; then
        lab
    elif [ "$1" = source ]; then
        source_distributions
    elif [ "$1" = wheel-linux-x86_64 ]; then
        with_kernels wheel x86_64-unknown-linux-gnu --zig --compatibility manylinux2014
    elif [ "$1" = wheel-linux-aarch64 ]; then
        with_kernels wheel aarch64-unknown-linux-gnu --zig --compatibility manylinux2014
    elif [ "$1" = wheel-musl-x86_64 ]; then
        wheel x86_64-unknown-linux-musl --zig --compatibility musllinux_1_2
    elif [ "$1" = wheel-musl-aarch64 ]; then
        wheel aarch64-unknown-linux-musl --zig --compatibility musllinux_1_2
    elif [ "$1" = wheel-windows-x86_64 ]; then
        (mingw && with_kernels wheel x86_64-pc-windows-gnu)
    elif [ "$1" = check ]; then
        python3 -B release/check.py "$out"
    elif [ "$1" = reproducible ]; then
        reproducible
    else
        printf 'error: there is no step %s: the head of release/build.sh lists them\n' "$1" >&2
        exit 2
    fi
}

# The laboratory without a server, written by the command of linux-x86_64.
lab() {
    local program=$stage/slipfront-$version-linux-x86_64/slipfront name=slipfront-$version-lab
    [ -x "$program" ] || step linux-x86_64
    rm -rf "${stage:?}/$name"
    "$program" lab --export "$stage/$name"
    "$program" lab --single "$out/$name.html"
    pack "$name" zip
}

# The sources of this commit, and those that pip builds from.
source_distributions() {
    venv
    git archive --format=tar --prefix="slipfront-$version/" HEAD | gzip --no-name > "$out/slipfront-$version-source.tar.gz"
    "$tools/bin/maturin" sdist --manifest-path python/Cargo.toml --out "$out"
}

# Builds this commit in a clone with another path, and compares the archive.
reproducible() {
    local archive=slipfront-$version-linux-x86_64.tar.gz
    [ -e "$out/$archive" ] || step linux-x86_64
    elsewhere=$(mktemp -d)
    # Of the whole script, since the function has ended by then.
    trap 'rm -rf "$elsewhere"' EXIT
    git clone --quiet . "$elsewhere/a folder of another name"
    (
        cd "$elsewhere/a folder of another name"
        unset CARGO_ENCODED_RUSTFLAGS CARGO_TARGET_DIR
        release/build.sh linux-x86_64
        cmp "target/dist/$archive" "$out/$archive"
    )
    printf '%s has the same bytes when it is built in two folders\n' "$archive"
}

steps=("$@")
if [ $# -eq 0 ]; then
    steps=(linux-x86_64 linux-aarch64 windows-x86_64 lab source wheel-linux-x86_64 wheel-linux-aarch64 wheel-musl-x86_64
        wheel-musl-aarch64 wheel-windows-x86_64 check reproducible)
fi
if [ -n "$(git status --porcelain)" ]; then
    printf 'warning: files have changed since the last commit, so that this is no release\n' >&2
fi
mkdir -p "$out"
for step in "${steps[@]}"; do
    step "$step"
done
(cd "$out" && find . -maxdepth 1 -type f ! -name SHA256SUMS -printf '%f\n' | LC_ALL=C sort | xargs sha256sum > SHA256SUMS && cat SHA256SUMS)
printf 'not made: macOS, whose programs cannot be linked here (release/README.md has a recipe that was not tried)\n'
