#!/usr/bin/env python3
"""How alike the first slips of two solvers are, block by block, over the whole run and with one step:

    compare_maps.py [ANSWERS]

prints a table in Markdown of all pairs of solvers that have maps of a problem: blocks that slipped in either, the share of them
that slipped in both within one step, and the largest difference. Chaos after the peak shows in P03 and P04. Needs NumPy.
"""

import itertools
import json
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent


def rows(answers):
    """Problem, two solvers, blocks, share within one step, largest difference in steps."""
    maps = {}
    for path in sorted(Path(answers).glob("*/P*/answers.json")):
        given = json.loads(path.read_text())
        if "first_slip_map" in given:
            slips = np.genfromtxt(path.parent / given["first_slip_map"], delimiter=",")
            maps.setdefault(given["id"], {})[path.parts[-3]] = given["dt"], slips
    for problem, found in sorted(maps.items()):
        for (one, (dt, a)), (other, (step, b)) in itertools.combinations(found.items(), 2):
            slipped = np.isfinite(a) | np.isfinite(b)
            apart = np.abs(a - b)[slipped] / dt
            if dt == step:
                yield problem, one, other, apart.size, float(np.mean(apart <= 1 + 1e-6)), float(np.nanmax(apart))


def main(answers):
    print("| problem | solvers | blocks | within one step | largest difference, steps |\n|---|---|---|---|---|")
    for problem, one, other, blocks, share, largest in rows(answers):
        print(f"| {problem} | {one}, {other} | {blocks} | {100 * share:.2f} % | {largest:.3g} |")


if __name__ == "__main__":
    main(sys.argv[1] if sys.argv[1:] else HERE / "answers")
