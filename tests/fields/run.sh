#!/bin/bash
# Lets other programs read fields files: netCDF-C, by way of xarray, and the reader of ParaView,
# vtkNetCDFCFReader; and netCDF-C a kymograph. One file of fields is of an ordinary lattice, one has arrays of
# more than 2 and 4 GiB; it is full of holes and takes less than 10 MB of the disk.
#
#     tests/fields/run.sh
#
# Needs cargo and what tests/venv.sh needs, which takes minutes the first time. Exit status: 2 when something
# is missing.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
work=$PWD/target/fields

mkdir -p "$work"
tests/venv.sh || exit 2
files=$(mktemp -d "$work/files.XXXXXX")
trap 'rm -rf "$files"' EXIT
SLIPFRONT_FIELDS=$files cargo test --quiet --locked --workspace --test run fields
target/venv/bin/python tests/fields/check.py "$files"
