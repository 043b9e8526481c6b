#!/usr/bin/env bash
# Writes RESULTS.md and results.json of the stored answers. Needs Python 3 with NumPy and a C compiler; PYTHON names another.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
python=${PYTHON:-python3}
# The surfaces of P12: the number is published after masks were sent.
seed=20261129
{
    sed -n '1,/^## Answers/p' results.head.md
    printf '\n'
    "$python" score.py --json results.json || true
    printf '\n## Maps of first slips\n\nWith the largest step of each problem:\n\n'
    "$python" compare_maps.py
    printf '\n## Designs\n\nMasks of P12 on three surfaces drawn from the seeds %d and on:\n\n' "$seed"
    "$python" rank_designs.py "$seed"
} > RESULTS.md.new
mv RESULTS.md.new RESULTS.md
