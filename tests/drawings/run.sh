#!/usr/bin/env bash
# Has the drawings of all cases read by ezdxf: it finds no error, all outlines are closed, and they fill the
# blocks that are textured in the field of the same case.
#
#     SLIPFRONT=target/debug/slipfront tests/drawings/run.sh
#
# Needs the command and what tests/venv.sh needs. Exit status: 1 when a drawing is not valid, 2 when something
# is missing.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
slipfront=$(realpath "${SLIPFRONT:-target/debug/slipfront}") || exit 2
tests/venv.sh || exit 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
draw() {
    for ending in dxf gsf; do
        "$slipfront" texture "${@:2}" -o "$work/$1.$ending" > /dev/null
    done
}
for case in cases/*.toml; do
    draw "$(basename "$case" .toml)" "$case"
done
dimples='{ shape = "cavity", lambda = "3 um", pitch = "9 um", lattice = "hexagonal" }'
strips='{ shape = "groove", width = "2 um", pitch = "7 um", orientation = "along" }'
for slider in disc gear; do
    draw "textured_$slider" "cases/$slider.toml" --set "texture=[$dimples, $strips]"
done
target/venv/bin/python tests/drawings/check.py "$work"
