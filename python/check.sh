#!/usr/bin/env bash
# Builds the Python package from its source distribution, in a folder without this checkout beside it,
# installs the wheel in target/venv, and runs the tests, the types and the notebooks with it.
#
#     python/check.sh
#
# Needs cargo and what tests/venv.sh needs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
repository=$PWD
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
work=$repository/target/python
rm -rf "$work"
mkdir -p "$work"

tests/venv.sh
bin=$repository/target/venv/bin
"$bin/maturin" sdist --manifest-path python/Cargo.toml --out "$work"
tar -xzf "$work"/slipfront-*.tar.gz -C "$folder"
# With the flags and in the folder of the other builds it takes the crates of others from there.
cp -r .cargo "$folder"
(cd "$folder"/slipfront-* && CARGO_TARGET_DIR="$repository/target" "$bin/maturin" build --profile dev --out "$work")
"$bin/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps "$work"/slipfront-*.whl

"$bin/pytest" --quiet -c python/pyproject.toml --rootdir python --numprocesses 2 --pyargs slipfront python/tests
cd python
"$bin/mypy" tests
"$bin/stubtest" slipfront --mypy-config-file pyproject.toml
"$bin/python" examples/run.py
"$bin/jupyter" nbconvert --log-level ERROR --to script --output-dir "$work/examples" examples/*.ipynb
"$bin/pyright" --pythonpath "$bin/python" tests "$work/examples"
