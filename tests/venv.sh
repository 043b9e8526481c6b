#!/usr/bin/env bash
# Makes target/venv, a venv with what tests in Python need from PyPI, 1.5 GB, unless it is there: xarray,
# netCDF4 and VTK for tests/fields, roc-validator and pybtex for tests/ro_crate, ezdxf for tests/drawings, SciPy
# for challenge, and what python/tests/requirements.txt lists. Needs python3 with venv. Exit status: 2 when
# something is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
made=target/venv/made
if ! cat python/tests/requirements.txt tests/venv.sh | cmp --silent "$made"; then
    python3 -m venv --clear target/venv || exit 2
    target/venv/bin/pip install --quiet --disable-pip-version-check ezdxf maturin netCDF4 pybtex roc-validator scipy vtk -r python/tests/requirements.txt || exit 2
    cat python/tests/requirements.txt tests/venv.sh > "$made"
fi
