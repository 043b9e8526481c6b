#!/usr/bin/env python3
"""Runs the command `slipfront` on a problem of the onset challenge:

    slipfront_solver.py PROBLEM OUTPUT [--dt DT] [--program slipfront] [--keep FOLDER]

writes the problem as a case with its arrays, runs it on one thread, and makes answers of the files of the run. Needs SciPy,
which reads its fields.
"""

import argparse
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import scipy.io

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import onset

# Strain of the load: it acts through the geometry of the springs alone, and 1e-10 of it is far below any tolerance here.
MODULUS, PRESSURE, DENSITY, BLOCK = 1e15, 1e5, 1e4, 1e-6
# A drive that has no springs is one with springs that pull nothing: the case file has no other.
NO_SPRING, NO_SPEED = 1e-12, 1e-9
# Path of the drive after which a run that counts events has enough of them.
CATALOGUE = 60000


def case(p, dt, folder):
    """Writes a problem as a case file with its arrays."""
    def array(name, field):
        np.save(folder / f"{name}.npy", field)
        return f'"{name}.npy"'

    tables = {name: {} for name in ("slider", "load", "drive", "friction", "time", "output")}
    textures = ""
    tables["slider"] = {
        "blocks": [p.nx, p.ny], "block_size": f'"{BLOCK} m"', "young_modulus": f'"{MODULUS} Pa"', "density": f'"{DENSITY} kg/m^3"',
        "omega_star": p.damping / math.sqrt(0.75), "viscosity_time_star": p.viscosity,
        "edges": "[" + ", ".join(f'"{"periodic" if periodic else "free"}"' for periodic in p.periodic) + "]"}
    if not p.exists.all():
        tables["slider"] |= {"outline": '"mask"', "outline_file": array("outline", p.exists.astype(np.uint8))}
    if not p.vector and not (p.contact == (np.arange(p.ny) == 0)[:, None]).all():
        raise SystemExit("slipfront has friction along x alone on the lowest row of an upright sheet, and on all of it")
    if p.vector and not p.contact[p.exists].all():
        textures = f'\n[[texture]]\nshape = "mask"\nfile = {array("texture", (p.exists & ~p.contact).astype(np.uint8))}\n'
    tables["load"] = {"pressure": f'"{PRESSURE} Pa"', "redistribute": "false",
                      "pressure_field": array("pressure", np.where(p.contact, p.normal, 1.0))}
    if p.prestress.any():
        tables["load"] |= {"shear_star": 1, "shear_field": array("shear", p.prestress)}
    stiffness = float(p.springs.max())
    if set(np.unique(p.springs[p.exists])) - {0.0, stiffness}:
        raise SystemExit("slipfront has drive springs of one stiffness")
    program = [f"{{ v_star = {(x1 - x0) / (t1 - t0)!r}, until_star = {t1} }}" for (t0, x0), (t1, x1) in zip(p.path, p.path[1:])]
    tables["drive"] = {"stiffness_star": stiffness or NO_SPRING}
    tables["drive"] |= {"program": f"[{', '.join(program)}]"} if len(program) > 1 else {
        "v_star": (p.path[1][1] / p.path[1][0]) or NO_SPEED}
    if stiffness and not (p.springs[p.exists] > 0).all():
        tables["drive"] |= {"attach_file": array("attach", (p.springs > 0).astype(np.uint8))}
    if isinstance(p.raw["drive"]["direction"][0], str):
        tables["drive"] |= {"motion": '"rotation"'}
    if p.held:
        tables["drive"] |= {"loading": '"held"'}
    law = p.friction
    if p.law == "rate_and_state":
        tables["friction"] = {"law": '"rate_and_state"', "mu_static": 1, "a": law["a"], "b": law["b"], "d_c_star": law["d_c"],
                              "v_0_star": law["v_0"], "mu_0": law["mu_0"], "theta_0_star": law["theta_0"],
                              "slip_speed_star": law["slip_speed"]}
    else:
        tables["friction"] = {"mu_static": 1, "mu_static_field": array("static", p.static),
                              "mu_kinetic_field": array("kinetic", p.kinetic)}
    if p.law == "slip_weakening":
        tables["friction"] |= {"slip_weakening": f"{{ length_star = {law['length']} }}"}
    if p.law == "velocity_weakening":
        tables["friction"] |= {"velocity": f'{{ law = "weakening", v_c_star = {law["v_c"]}, ratio = {law["ratio"]} }}'}
    if not p.vector:
        tables["friction"] |= {"along": '"x"'}
    tables["time"] = {"step": dt, "duration_star": p.until or CATALOGUE}
    tables["output"] = {"snapshots": "[]", "series": dt if p.until else 1000.0}
    if "events" in p.answers or "histogram" in p.answers:
        tables["output"] |= {"events": "true"}
    text = "".join(f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items()) for name, keys in tables.items())
    (folder / "case.toml").write_text(text + textures)
    return folder / "case.toml"


def columns(path):
    """A CSV file with a header as columns by name."""
    with path.open() as file:
        names = file.readline().strip().split(",")
    return dict(zip(names, np.genfromtxt(path, delimiter=",", skip_header=1, ndmin=2).T))


def record(p, dt, folder):
    """The record of a run that `onset.answers` takes."""
    series = columns(folder / "series.csv")
    times, force = series["time_star"], series["mu_star"]
    with scipy.io.netcdf_file(folder / "fields.nc", mmap=False) as fields:
        first_slips = np.array(fields.variables["first_slip_time_star"].data, float)
    events, speeds = np.zeros((0, 6)), None
    if p.nx * p.ny == 1:
        # The displacement of one block on its spring is the path less the pull over the stiffness.
        slides = series["sliding_percent"] > 0
        u = np.array([p.reach(t) for t in times]) - force / p.springs[0, 0]
        begins = np.flatnonzero(slides & ~np.concatenate([[False], slides[:-1]]))
        ends = [b + int(np.argmin(slides[b:])) for b in begins]
        whole = [(b, e) for b, e in zip(begins, ends) if e > b]
        events = np.array([(times[b], times[e], 1, u[e] - u[b], force[b], force[e]) for b, e in whole]).reshape(-1, 6)
        speeds = np.array([np.max(np.abs(np.diff(u[b : e + 1]))) / dt for b, e in whole])
    elif (folder / "events.csv").is_file():
        table = columns(folder / "events.csv")
        events = np.stack([table[name] for name in ("time_star", "until_star", "blocks", "moment_star", "mu_star_before", "mu_star_after")], axis=1)
        # An event that has not ended has empty fields.
        events = events[np.isfinite(events).all(axis=1)]
    wanted = p.raw.get("until_events", 0)
    if len(events) < wanted:
        raise SystemExit(f"the run has {len(events)} events, and {wanted} are asked for: CATALOGUE is too short a path")
    return times, force, first_slips, events[: wanted or None], speeds


def simulate(p, dt, program, folder):
    """Runs a problem; answers with its record."""
    path = case(p, dt, folder)
    command = [program, "run", path, "-o", folder / "run", "--threads", "1", "--no-pictures", "--checkpoint", "off", "--force"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    return record(p, dt, folder / "run")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problem")
    parser.add_argument("output")
    parser.add_argument("--dt", type=float, help="step; the largest that the problem allows if not given")
    parser.add_argument("--program", default="slipfront")
    parser.add_argument("--keep", type=Path, help="folder for the case and its run")
    given = parser.parse_args()
    p = onset.Problem(given.problem)
    dt = given.dt or p.raw["step_max"]
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = given.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        found = onset.answers(p, *simulate(p, dt, given.program, folder))
    version = subprocess.run([given.program, "--version"], capture_output=True, text=True).stdout.splitlines()[0]
    onset.write(given.output, p, version, dt, found, time.perf_counter() - began)


if __name__ == "__main__":
    main()
