#!/bin/bash
# Lets other programs read fields files: netCDF-C, by way of xarray, and the reader of ParaView, vtkNetCDFCFReader; and netCDF-C a
# kymograph. One file of fields is of an ordinary lattice, one has arrays of more than 2 and 4 GiB; it is full of holes and takes less
# than 10 MB of the disk.
#
#     tests/fields/run.sh
#
# Needs cargo and python3 with venv. xarray, netCDF4 and VTK are put into target/fields/venv from PyPI, 0.9 GB. Takes a minute the
# first time. Exit status: 2 when something is missing.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
work=$PWD/target/fields
python=$work/venv/bin/python

mkdir -p "$work"
if ! "$python" -c 'import netCDF4, vtkmodules, xarray' 2> /dev/null; then
  python3 -m venv --clear "$work/venv" && "$python" -m pip install --quiet --disable-pip-version-check xarray netCDF4 vtk || exit 2
fi
files=$(mktemp -d "$work/files.XXXXXX")
trap 'rm -rf "$files"' EXIT
SLIPFRONT_FIELDS=$files cargo test --quiet --locked -p slipfront-run --test fields
"$python" tests/fields/check.py "$files"
