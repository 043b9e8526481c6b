#!/usr/bin/env bash
# Has crates of `slipfront export --ro-crate` validated by roc-validator: a run in its folder, two runs as one
# crate, a study with a kept run and one that failed, and a design. Has its citations read by pybtex and
# PyYAML.
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
cat > "$work/study.toml" <<'TOML'
[base]
slider = { blocks = [6, 6], omega_star = 0 }
drive = { v_star = 10 }
friction = { r_star = 0, sigma_static_star = 1 }
time = { step = 0.9, duration_star = 2000 }
[study]
keep = "all"
[[axes]]
key = "load.pressure"
list = ["50 GPa", "100 kPa"]
TOML
"$slipfront" study "$work/study.toml" --quiet -o "$work/study" 2> /dev/null || [ $? = 1 ]
"$slipfront" design cases/designs/least_friction.toml --quiet --time 1s -o "$work/design"
"$slipfront" export "$work/study" "$work/design" --ro-crate --author "An Author" --licence CC-BY-4.0 -o "$work/many" > /dev/null
"$slipfront" export "$work/study" --ro-crate > /dev/null
target/venv/bin/python tests/ro_crate/citations.py "$slipfront" "$work/block"
# The validator does not understand a blank in the path of a crate itself.
target/venv/bin/python tests/ro_crate/validate.py "$work/block" "$work/both" "$work/study" "$work/many"
