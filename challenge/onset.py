"""Problems and answers of the onset challenge: reading, the definitions of answers, writing. NumPy alone."""

import argparse
import bisect
import json
import platform
import time
from pathlib import Path

import numpy as np


class Problem:
    """A problem with every field as an array of shape (ny, nx), the row at y = 0 first."""

    def __init__(self, folder, replaced=None):
        """Reads a folder; `replaced` has arrays in place of files, which a designed mask and drawn surfaces are."""
        self.folder, self.replaced = Path(folder), replaced or {}
        self.raw = json.loads((self.folder / "problem.json").read_text())
        if self.raw["format"] != "onset-1":
            raise ValueError(f"{folder}: format {self.raw['format']!r} is not 'onset-1'")
        lattice, drive, friction = self.raw["lattice"], self.raw["drive"], self.raw["friction"]
        if lattice["geometry"] != "linear" or lattice["halve_edge_springs"] or self.raw["mass"] != 1:
            raise ValueError(f"{folder}: version 1 has linear springs, edges that are not halved, and blocks of mass 1")
        self.nx, self.ny, self.k1, self.k2 = (lattice[key] for key in ("nx", "ny", "k1", "k2"))
        self.periodic = [edge == "periodic" for edge in lattice["edges"]]
        self.viscosity, self.damping = lattice["viscosity"], self.raw["damping"]
        self.exists = self.field(lattice["blocks"]) != 0
        direction = drive["direction"]
        self.direction = [self.field(part) * self.exists for part in direction]
        # Sum of |g|, over which the drive force is taken: the number of blocks of a translation.
        self.weight = float(np.sum(np.hypot(*self.direction)))
        self.springs, self.prestress = self.field(drive["springs"]) * self.exists, self.field(drive["prestress"] or 0)
        self.path, self.held = drive["path"], drive["held"]
        self.corners = [t for t, _ in self.path]
        self.contact, self.normal = (self.field(self.raw["contact"]) != 0) & self.exists, self.field(self.raw["normal"])
        self.friction, self.law, self.vector = friction, friction["law"], friction["vector"]
        self.static, self.kinetic = (self.field(friction[key] or 0) for key in ("static", "kinetic"))
        self.until, self.answers = self.raw["until"], self.raw["answers"]

    def field(self, given):
        """A number, the name of a CSV file, or rows of either among blocks of one value."""
        whole = np.zeros((self.ny, self.nx))
        if isinstance(given, dict):
            whole[:] = given["else"]
            for row, values in given["rows"].items():
                whole[int(row)] = self.csv(values) if isinstance(values, str) else values
        else:
            whole[:] = self.csv(given) if isinstance(given, str) else given
        return whole

    def csv(self, name):
        return self.replaced[name] if name in self.replaced else np.loadtxt(self.folder / name, delimiter=",", ndmin=2)

    def reach(self, time):
        """Path X of the far ends of the drive springs at the time of the drive."""
        at = bisect.bisect_right(self.corners, time, hi=len(self.path) - 1)
        (t0, x0), (t1, x1) = self.path[at - 1 : at + 1]
        return x0 + (x1 - x0) * ((time - t0) / (t1 - t0))


def static(times, force, level):
    """Largest drive force before the first fall to half-way between itself and `level`, and its time."""
    highest = np.maximum.accumulate(force)
    fallen = np.flatnonzero((highest > level) & (force <= 0.5 * (highest + level)))
    at = int(np.argmax(force[: fallen[0] + 1] if fallen.size else force))
    return float(force[at]), float(times[at])


def kinetic(times, force, start, end):
    """Mean drive force over the instants from `start` to `end`."""
    return float(np.mean(force[(times >= start - 1e-9) & (times <= end + 1e-9)]))


def front(first_slips, row, windows):
    """Speed of the front in blocks per unit of time over each window: one over the slope of first slips by least squares."""
    speeds = []
    for first, last in windows:
        t = first_slips[row, first : last + 1]
        speeds.append(float(1 / np.polyfit(np.arange(t.size), t, 1)[0]) if np.all(np.isfinite(t)) else None)
    return speeds


def period(events, from_event):
    """Mean interval between the beginnings of successive events, from the event of this number on."""
    begins = events[from_event - 1 :, 0]
    return float((begins[-1] - begins[0]) / (begins.size - 1))


def histogram(events, from_event, parts, ln_moment, bins):
    """Counts of events over equal bins of the logarithm of the moment, a row for each of the parts of the catalogue, with
    the number of events of all blocks in the last column."""
    counted = events[from_event - 1 :]
    rows = []
    for part in np.array_split(counted, parts):
        logarithms = np.log(part[part[:, 3] > 0, 3])
        counts = np.histogram(logarithms, bins, ln_moment)[0]
        rows.append([*counts, np.sum(part[:, 2] == counted[:, 2].max())])
    return np.array(rows)


def longest(events):
    """The events with more blocks than every event before."""
    before = np.concatenate([[0], np.maximum.accumulate(events[:, 2])[:-1]])
    return events[events[:, 2] > before]


EVENT = "t_begin,t_end,blocks,moment,force_before,force_after"


def answers(problem, times, force, first_slips, events, speeds):
    """Every answer that a problem asks for, from a record: drive force over time, first slips by block (NaN for none), rows
    of events, the largest speed of each. Arrays stay arrays; `write` makes files of them."""
    found = {}
    for name, asked in problem.answers.items():
        if name == "first_slip":
            found[name] = float(np.nanmin(first_slips))
        elif name == "first_slip_force":
            found[name] = float(np.interp(np.nanmin(first_slips), times, force))
        elif name == "static":
            found[name], found["static_time"] = static(times, force, asked["level"])
        elif name == "kinetic":
            found[name] = kinetic(times, force, asked["from"], asked["to"])
        elif name == "front":
            found[name] = front(first_slips, asked["row"], asked["windows"])
        elif name == "first_slip_map":
            found[name] = first_slips[asked["rows"]] if "rows" in asked else first_slips
        elif name == "events":
            found[name] = longest(events) if asked.get("longest") else events[: asked["first"]]
        elif name == "period":
            found[name] = period(events, asked["from_event"])
        elif name == "peak_speed":
            found[name] = float(np.max(speeds[asked["from_event"] - 1 :]))
        elif name == "histogram":
            found[name] = histogram(events, asked["from_event"], asked["parts"], asked["ln_moment"], asked["bins"])
    return found


def write(folder, problem, solver, dt, found, wall, error=None):
    """Writes answers.json and its tables into a folder."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    whole = {"format": "onset-1", "id": problem.raw["id"], "solver": solver, "dt": dt, "error": error or {}}
    for name, value in found.items():
        if isinstance(value, np.ndarray):
            cell = lambda x: "" if np.isnan(x) else f"{x:.9g}"
            lines = [",".join(map(cell, row)) for row in value]
            if name == "events":
                lines.insert(0, EVENT)
            whole[name] = f"{name}.csv"
            (folder / whole[name]).write_text("\n".join(lines) + "\n")
        else:
            whole[name] = value
    whole |= {"wall_s": round(wall, 2), "machine": platform.machine()}
    (folder / "answers.json").write_text(json.dumps(whole, indent=1) + "\n")


def estimate(folder):
    """Writes into the answers of half the step their distance from those of the whole step, as an estimate of their error."""
    whole, path = json.loads((Path(folder) / "answers.json").read_text()), Path(folder) / "half/answers.json"
    half = json.loads(path.read_text())
    for name, value in half.items():
        if isinstance(value, (float, list)) and name not in ("dt", "wall_s"):
            apart = np.abs(np.subtract(np.array(value, float), np.array(whole[name], float)))
            half["error"][name] = float(f"{np.max(apart):.3g}")
    path.write_text(json.dumps(half, indent=1) + "\n")


def solve(description, solver, simulate):
    """The command line of a solver: `simulate` runs a problem with a step, and returns what `answers` takes."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("problem")
    parser.add_argument("output")
    parser.add_argument("--dt", type=float, help="step; the largest that the problem allows if not given")
    given = parser.parse_args()
    problem = Problem(given.problem)
    dt = given.dt or problem.raw["step_max"]
    began = time.perf_counter()
    found = answers(problem, *simulate(problem, dt))
    write(given.output, problem, solver, dt, found, time.perf_counter() - began)
