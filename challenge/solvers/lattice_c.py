#!/usr/bin/env python3
"""Runs lattice.c on a problem of the onset challenge:

    lattice_c.py PROBLEM OUTPUT [--dt DT] [--explicit]

The C compiler is `cc`, or CC of the environment; the program is compiled into the folder of temporary files.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import onset

LAWS = {"coulomb": [], "slip_weakening": ["length"], "velocity_weakening": ["v_c", "ratio"],
        "rate_and_state": ["a", "b", "d_c", "v_0", "mu_0", "theta_0", "slip_speed"]}


def compiled(folder):
    """Compiles lattice.c into a folder; answers with the program."""
    program = Path(folder) / "lattice"
    subprocess.run([os.environ.get("CC", "cc"), "-std=c99", "-O2", "-o", program, HERE / "lattice.c", "-lm"], check=True)
    return program


def flat(p, dt, explicit):
    """A problem as the text that lattice.c reads; -1 stands for what does not end the run."""
    numbers = [p.friction[key] for key in LAWS[p.law]]
    head = [p.nx, p.ny, *p.periodic, p.k1, p.k2, p.viscosity, p.damping, dt, -1 if p.until is None else p.until,
            p.raw.get("until_events", -1), list(LAWS).index(p.law), p.vector, p.held, explicit,
            *numbers, *[0] * (8 - len(numbers)), len(p.path), *[x for corner in p.path for x in corner]]
    # Under rate and state the normal force stands in the place of the static threshold.
    holds = p.normal if p.law == "rate_and_state" else p.static * p.normal
    fields = [p.exists, p.contact, p.springs, *p.direction, p.prestress, holds, p.kinetic * p.normal]
    rows = np.stack([field.astype(float).ravel() for field in fields], axis=1)
    lines = [" ".join(repr(float(x)) for x in row) for row in rows]
    return "\n".join([" ".join(repr(float(x)) for x in head), *lines]) + "\n"


def simulate(p, dt, explicit=False, program=None):
    """Runs a problem; answers with the record of it that `onset.answers` takes."""
    with tempfile.TemporaryDirectory() as folder:
        names = [str(Path(folder) / name) for name in ("series", "slips", "events")]
        subprocess.run([program or compiled(folder), *names], input=flat(p, dt, explicit), text=True, check=True)
        series, slips, events = ([line.split(",") for line in Path(name).read_text().splitlines()] for name in names)
    series = np.array(series, float).reshape(-1, 2)
    events = np.array(events, float).reshape(-1, 7)
    return series[:, 0], series[:, 1], np.array(slips, float), events[:, :6], events[:, 6]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problem")
    parser.add_argument("output")
    parser.add_argument("--dt", type=float, help="step; the largest that the problem allows if not given")
    parser.add_argument("--explicit", action="store_true", help="friction acts explicitly against the velocity")
    given = parser.parse_args()
    p = onset.Problem(given.problem)
    dt = given.dt or p.raw["step_max"]
    began = time.perf_counter()
    found = onset.answers(p, *simulate(p, dt, given.explicit))
    name = "lattice.c 1, explicit friction" if given.explicit else "lattice.c 1"
    onset.write(given.output, p, name, dt, found, time.perf_counter() - began)


if __name__ == "__main__":
    main()
