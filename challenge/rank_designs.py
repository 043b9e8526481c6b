#!/usr/bin/env python3
"""Ranks the masks of P12 by the static friction of runs in two solvers on surfaces that a seed draws.

    rank_designs.py SEED [ANSWERS] [--markdown FILE]

Whoever scores chooses the seed after the masks were sent, and publishes it. The exit status is 1 where a mask is refused.
Needs NumPy and a C compiler.
"""

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "solvers")]
import lattice
import lattice_c
import make_problems
import onset
from score import Refused, Run

SURFACES = 3


def ranked(answers, seed):
    """Static friction of the masks of P12 in two solvers on drawn surfaces, least first."""
    folder = HERE / "problems" / "P12"
    asked = json.loads((folder / "problem.json").read_text())
    ny, nx, level = asked["lattice"]["ny"], asked["lattice"]["nx"], asked["answers"]["static"]["level"]
    rows = []
    for path in sorted(Path(answers).glob("*/P12")):
        row = {"design": path.parent.name}
        try:
            mask = Run(path, asked).table("mask")
            touching = asked["answers"]["mask"]["touching"]
            if mask.shape != (ny, nx) or not np.isin(mask, (0, 1)).all() or mask.sum() != touching:
                raise Refused(f"the mask needs {ny} rows of {nx} numbers 0 and 1, {touching} of them 1")
            for number in range(SURFACES):
                spread = asked["answers"]["mask"]["spread"]
                surface = 1 + spread * np.reshape(make_problems.normals(seed + number, nx * ny), (ny, nx))
                p = onset.Problem(folder, {"mask.csv": mask, "static.csv": surface})
                for name, solver in (("lattice.py", lattice), ("lattice.c", lattice_c)):
                    times, force = solver.simulate(p, asked["step_max"])[:2]
                    row.setdefault(name, []).append(onset.static(times, force, level)[0])
            row |= {"static": float(np.mean(row["lattice.py"] + row["lattice.c"])), "between_surfaces": float(np.std(row["lattice.c"])),
                    "between_solvers": float(np.max(np.abs(np.subtract(row["lattice.py"], row["lattice.c"]))))}
        except Refused as wrong:
            row["why"] = str(wrong)
        rows.append(row)
    return sorted(rows, key=lambda row: row.get("static", math.inf))


def markdown(rows):
    """One table, and a line for each mask that was refused."""
    lines = ["| design | static friction | between surfaces | between solvers |", "|---|---|---|---|"]
    lines += [f"| {r['design']} | {r['static']:.4f} | {r['between_surfaces']:.4f} | {r['between_solvers']:.1e} |" for r in rows if "static" in r]
    return "\n".join(lines + [f"\n- {r['design']}: {r['why']}" for r in rows if "why" in r]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seed", type=int)
    parser.add_argument("answers", nargs="?", default=HERE / "answers")
    parser.add_argument("--markdown", type=Path)
    given = parser.parse_args()
    rows = ranked(given.answers, given.seed)
    print(markdown(rows), end="")
    if given.markdown:
        given.markdown.write_text(markdown(rows))
    return 1 if any("why" in row for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
