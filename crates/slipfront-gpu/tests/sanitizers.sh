#!/usr/bin/env bash
# Tests the kernels for a GPU on threads of the CPU, under sanitizers of GCC: `thread` finds memory that threads
# use without a barrier between them, `address` finds uses of memory beyond the end of an array.
#
#     crates/slipfront-gpu/tests/sanitizers.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
# Rust code is not watched, so that the sanitizer does not see how its threads wait for each other.
suppressions=$(mktemp)
trap 'rm "$suppressions"' EXIT
echo 'race:^_R' > "$suppressions"
# Some versions of Linux place memory at random addresses where the sanitizers do not expect it.
fixed=
if setarch --addr-no-randomize true; then fixed="'setarch', '--addr-no-randomize', "; fi
# The features and `--bins` are those of .ci/run, so that the crates below need not be compiled again.
for sanitizer in thread address; do
    # The functions of the sanitizer take the place of those of the C library, so that it is loaded first.
    library=$(c++ -print-file-name="lib${sanitizer:0:1}san.so")
    SLIPFRONT_SANITIZER=$sanitizer cargo test \
        --config "target.'cfg(all())'.runner = [$fixed'env', 'LD_PRELOAD=$library', 'TSAN_OPTIONS=suppressions=$suppressions']" \
        --workspace --features 'slipfront-gpu/cuda slipfront-gpu/emulated' --locked --bins --test same_bits few_blocks
done
