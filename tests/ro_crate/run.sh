#!/usr/bin/env bash
# Has crates of `slipfront export --ro-crate` validated by roc-validator: a run in its folder, and two runs as
# one crate. Has its citations read by pybtex and PyYAML.
#
#     SLIPFRONT=target/debug/slipfront tests/ro_crate/run.sh
#
# Needs the command and what tests/venv.sh needs. Exit status: 1 when a crate or a citation is not valid, 2
# when something is missing.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
slipfront=$(realpath "${SLIPFRONT:-target/debug/slipfront}") || exit 2
tests/venv.sh || exit 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$slipfront" run cases/given_surface.toml --quiet -o "$work/a surface"
"$slipfront" run cases/single_block.toml --quiet -o "$work/block"
"$slipfront" export "$work/a surface" "$work/block" --ro-crate --author "An Author" --licence CC-BY-4.0 -o "$work/both" > /dev/null
"$slipfront" export "$work/block" --ro-crate > /dev/null
target/venv/bin/python tests/ro_crate/citations.py "$slipfront" "$work/block"
# The validator does not understand a blank in the path of a crate itself.
target/venv/bin/python tests/ro_crate/validate.py "$work/block" "$work/both"
