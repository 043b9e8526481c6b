#!/usr/bin/env python3
"""Scores answers to the onset challenge against `reference.json`, and solvers against one another where nothing is exact.

    score.py [ANSWERS] [--only SOLVER...] [--markdown FILE] [--json FILE]

ANSWERS, `answers` beside this file if not given, has a folder for each solver, in it one for each problem with answers.json, and
in that `half` with the answers of half the step. The exit status is 1 where an answer fails. Needs NumPy. rank_designs.py ranks
the masks of P12.
"""

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
# What units and definitions that are not those of the problem multiply a number with.
FACTORS = {"2/3": 2 / 3, "3/4": 3 / 4, "1/2": 1 / 2, "3/8": 3 / 8, "sqrt(3/4)": math.sqrt(3 / 4), "sqrt(3/8)": math.sqrt(3 / 8),
           "sqrt(1/2)": math.sqrt(1 / 2), "1/pi": 1 / math.pi, "1/(2 pi)": 1 / (2 * math.pi), "1/10": 0.1, "1/100": 0.01, "1/1000": 0.001}


class Refused(Exception):
    """An answer that cannot be scored, with the reason as a sentence."""


class Run:
    """Answers of one run."""

    def __init__(self, folder, problem):
        self.folder, path = folder, folder / "answers.json"
        if not path.is_file():
            raise Refused(f"there is no {path.name} in {folder.name}")
        try:
            self.given = json.loads(path.read_text())
        except ValueError as error:
            raise Refused(f"answers.json is no JSON: {error}") from None
        for key, wanted in (("format", "onset-1"), ("id", problem["id"])):
            if self.given.get(key) != wanted:
                raise Refused(f"`{key}` is {self.given.get(key)!r}, and has to be {wanted!r}")
        self.dt = self.given.get("dt")
        if not isinstance(self.dt, (int, float)) or not 0 < self.dt <= problem["step_max"] * (1 + 1e-9):
            raise Refused(f"`dt` is {self.dt!r}, and has to be a number above 0, at most {problem['step_max']}")

    def number(self, name):
        """A number or a list of numbers; null stands for what has not happened."""
        value = self.given.get(name)
        for x in value if isinstance(value, list) else [value]:
            if isinstance(x, bool) or not isinstance(x, (int, float)) and not (x is None and isinstance(value, list)):
                raise Refused(f"`{name}` is {value!r}, and has to be a number or a list of numbers, without a unit")
        return np.array(value, float)

    def table(self, name, header=0):
        """A CSV file that an answer names; empty fields are NaN."""
        file = self.given.get(name)
        if not isinstance(file, str) or not (self.folder / file).is_file():
            raise Refused(f"`{name}` is {file!r}, and has to name a CSV file beside answers.json")
        rows = [line.split(",") for line in (self.folder / file).read_text().splitlines()[header:]]
        if len({len(row) for row in rows}) > 1:
            raise Refused(f"the rows of {file} differ in length")
        try:
            return np.array([[float(x) if x.strip() else math.nan for x in row] for row in rows])
        except ValueError as error:
            raise Refused(f"{file}: {error}") from None

    def value(self, name, row, problem):
        """The answer that a row of the reference asks for, derived from the tables where it is not given as a number."""
        if name == "first_slip_map":
            return self.shaped_map(problem)
        if name in ("slip_begins", "force_at_rest"):
            return self.table("events", 1)[:, 0 if name == "slip_begins" else 5]
        if name == "curve_rms":
            # F_T/F_N after precursors against R [(1 - theta) lambda + theta lambda^2].
            events, curve = self.table("events", 1), row["curve"]
            events = events[events[:, 2] >= curve["from"]]
            reach = events[:, 2] / problem["lattice"]["nx"]
            exact = curve["ratio"] * ((1 - curve["theta"]) * reach + curve["theta"] * reach**2)
            return np.sqrt(np.mean((events[:, 5] / exact - 1) ** 2)) if len(events) else np.array(math.nan)
        if name in ("load_excess", "runaway_excess"):
            slips, middle = self.shaped_map(problem)[0], problem["lattice"]["nx"] // 2
            times = [min(slips[middle - n // 2 - 1], slips[middle + n // 2 + 1]) for n in row["sizes"]]
            drive, at = problem["drive"], str(row["row"])
            reach = np.interp(times, *np.transpose(drive["path"]))
            return drive["prestress"]["rows"][at] + drive["springs"]["rows"][at] * reach - 1
        if name in ("exponent", "whole_chain_share"):
            counts = self.table("histogram")
            asked = problem["answers"]["histogram"]
            if counts.shape != (asked["parts"], asked["bins"] + 1):
                raise Refused(f"histogram.csv has the shape {counts.shape}, and needs {asked['parts']} rows of {asked['bins'] + 1}")
            return exponent(counts.sum(axis=0), asked, row["bins"]) if name == "exponent" else counts[:, -1].sum() / counts[:, :-1].sum()
        return self.number(name)

    def shaped_map(self, problem):
        slips, asked, lattice = self.table("first_slip_map"), problem["answers"]["first_slip_map"], problem["lattice"]
        shape = (len(asked["rows"]) if "rows" in asked else lattice["ny"], lattice["nx"])
        if slips.shape != shape:
            raise Refused(f"the map of first slips has the shape {slips.shape}, and needs {shape}: rows from y = 0 on")
        return slips


def exponent(counts, asked, window):
    """Minus the slope of ln(events in a bin) over ln M by least squares, over the bins within the window that have events."""
    low, high = asked["ln_moment"]
    middles = low + (np.arange(asked["bins"]) + 0.5) * (high - low) / asked["bins"]
    used = (middles > window[0]) & (middles < window[1]) & (counts[:-1] > 0)
    return -np.polyfit(middles[used], np.log(counts[:-1][used]), 1)[0]


def allowed(row, value, dt):
    """How far each number may be from the reference."""
    given = row["tolerance"]
    return np.asarray(given.get("abs", 0)) + given.get("rel", 0) * np.abs(value) + np.asarray(given.get("dt", 0)) * dt + given.get("dt2", 0) * dt**2


def compare(name, row, found, value, dt, peak):
    """Share of the tolerance that an answer takes, of the worst number; 1 and less passes."""
    if found.shape != value.shape:
        raise Refused(f"`{name}` has {found.size} numbers, and needs {value.size}")
    if "share" in row["tolerance"]:
        # A map, up to the peak: the part of the blocks that is too far off over the part that may be.
        seen = value <= peak
        wrong = ~(np.abs(found - value)[seen] <= allowed(row, 0, dt) * (1 + 1e-9))
        return float(wrong.mean() / (1 - row["tolerance"]["share"]))
    if "factor" in row["tolerance"]:
        return float(np.max(np.abs(np.log(found / value)) / math.log(row["tolerance"]["factor"])))
    # Where the reference has none, nor may the answer have a number.
    both = np.isnan(found) & np.isnan(value)
    used = np.where(both, 0, np.abs(found - value) / allowed(row, value, dt))
    return math.inf if np.isnan(used).any() else float(np.max(used))


def factor(found, value):
    """The name of a factor, if all numbers are within 1 % of that times their reference."""
    usable = np.isfinite(found) & np.isfinite(value) & (value != 0) & (found != 0)
    ratios = (found[usable] / value[usable]) if found.shape == value.shape and usable.any() else np.array([])
    for name, size in FACTORS.items():
        for label, wanted in ((name, size), (f"1/({name})", 1 / size)):
            if ratios.size and np.all(np.abs(ratios / wanted - 1) < 0.01):
                return f"off by the factor {label} = {wanted:.4g}: another unit or definition?"
    return None


def bound_broken(bound, found):
    """A sentence where a front breaks a bound that is exact."""
    speeds = found[bound["from_window"] :]
    if "max" in bound and not np.all(speeds[np.isfinite(speeds)] <= bound["max"]):
        return f"{np.nanmax(speeds):.4g} is above {bound['max']:.4g}: {bound['reason']}"
    if "min" in bound and not np.all(speeds >= bound["min"]):
        return f"{np.min(speeds):.4g} is below {bound['min']:.4g}: {bound['reason']}"
    return None


def judge(name, row, runs, values, problem, medians, peak):
    """The verdict on one answer of one solver, from its run and that with half the step."""
    verdict = {"value": np.round(values[-1], 10).tolist() if values[-1].size < 20 else None, "dt": [run.dt for run in runs],
               "own_error": runs[-1].given.get("error", {}).get(name)}
    if len(values) == 2 and values[0].shape == values[1].shape and values[0].size < 20:
        verdict["between_steps"] = float(np.max(np.abs(values[0] - values[1])))
    reference = medians if row["value"] is None else np.array(row["value"], float)
    if row["value"] is None and len(runs) < 2:
        raise Refused("open answers need a second run with half the step, in `half`")
    broken = next((b for b in (bound_broken(row["bound"], v) for v in values) if b), None) if "bound" in row else None
    if reference is None:
        return verdict | {"verdict": "fail" if broken else "open", "why": broken or "fewer than three solvers"}
    # Exact answers hold for each run with its own step; the median is that of the finer runs.
    judged = zip(runs, values) if row["value"] is not None else [(runs[-1], values[-1])]
    used = max(compare(name, row, found, reference, run.dt, peak) for run, found in judged)
    verdict |= {"tolerance_used": round(used, 4), "verdict": "fail" if used > 1 or broken else "pass"}
    if verdict["verdict"] == "fail":
        verdict["why"] = broken or next(filter(None, (factor(v, reference) for v in values)), None) or f"{used:.3g} times the tolerance off, which has its reason: {row['reason']}"
    return verdict


def score(answers, only=None):
    """Verdicts on all answers of all solvers, by problem, answer and solver."""
    reference = json.loads((HERE / "reference.json").read_text())["problems"]
    solvers = sorted(path.name for path in Path(answers).iterdir() if path.is_dir() and (not only or path.name in only))
    verdicts = {}
    for problem_id, rows in reference.items():
        if problem_id == "P12":
            continue
        problem = json.loads((HERE / "problems" / problem_id / "problem.json").read_text())
        runs = {}
        for solver in solvers:
            folder = Path(answers) / solver / problem_id
            if not folder.is_dir():
                continue
            try:
                runs[solver] = [Run(folder, problem)]
                if (folder / "half").is_dir():
                    runs[solver].append(Run(folder / "half", problem))
                    if not math.isclose(2 * runs[solver][1].dt, runs[solver][0].dt, rel_tol=1e-6):
                        raise Refused(f"the steps are {runs[solver][0].dt} and {runs[solver][1].dt}, and the second has to be half of the first")
            except Refused as wrong:
                runs[solver] = wrong
        for name, row in rows.items():
            found, cells = {}, verdicts.setdefault(problem_id, {}).setdefault(name, {})
            for solver, its in runs.items():
                try:
                    if isinstance(its, Refused):
                        raise its
                    found[solver] = [np.asarray(run.value(name, row, problem)) for run in its]
                except Refused as wrong:
                    cells[solver] = {"verdict": "refused", "why": str(wrong)}
            # The median of the finer runs, of three solvers at least.
            fine = [values[1] for values in found.values() if len(values) == 2]
            fine = [value for value in fine if value.shape == fine[0].shape]
            medians = np.median(fine, axis=0) if len(fine) >= 3 else None
            peaks = [its[-1].given.get("static_time", math.nan) for its in runs.values() if not isinstance(its, Refused)]
            for solver, values in found.items():
                try:
                    cells[solver] = judge(name, row, runs[solver], values, problem, medians, np.median(peaks))
                except Refused as wrong:
                    cells[solver] = {"verdict": "refused", "why": str(wrong)}
            if medians is not None and row["value"] is None:
                ranked = sorted(cell["tolerance_used"] for cell in cells.values() if "tolerance_used" in cell)
                for cell in cells.values():
                    if "tolerance_used" in cell:
                        cell["rank"] = 1 + ranked.index(cell["tolerance_used"])
    return verdicts


def markdown(verdicts):
    """One table of all answers, and a line for each that is not passed."""
    solvers = sorted({solver for rows in verdicts.values() for cells in rows.values() for solver in cells})
    lines = [f"| problem | answer | {' | '.join(solvers)} |", "|---|---|" + "---|" * len(solvers)]
    notes = []
    for problem, rows in verdicts.items():
        for name, cells in rows.items():
            texts = []
            for solver in solvers:
                cell = cells.get(solver)
                if cell and "why" in cell:
                    notes.append(f"- {problem} {name}, {solver}: {cell['why']}")
                texts.append(text_of(cell) if cell else "")
            lines.append(f"| {problem} | {name} | {' | '.join(texts)} |")
    return "\n".join(lines + ([""] + notes if notes else [])) + "\n"


def text_of(cell):
    """A verdict in a cell: value, share of the tolerance, own error or change with the step, place among solvers."""
    value = cell.get("value")
    parts = [cell["verdict"]] + ([f"{value:.6g}"] if isinstance(value, float) else [])
    if "tolerance_used" in cell:
        parts.append(f"{100 * cell['tolerance_used']:.3g} % of the tolerance")
    own = cell.get("own_error")
    if isinstance(own, (int, float)):
        parts.append(f"own error {own:.1e}")
    elif "between_steps" in cell:
        parts.append(f"{cell['between_steps']:.1e} between steps")
    return ", ".join(parts + ([f"rank {cell['rank']}"] if "rank" in cell else []))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("answers", nargs="?", default=HERE / "answers")
    parser.add_argument("--only", nargs="+", metavar="SOLVER")
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--json", type=Path)
    given = parser.parse_args()
    verdicts = score(given.answers, given.only)
    table = markdown(verdicts)
    print(table, end="")
    if given.markdown:
        given.markdown.write_text(table)
    if given.json:
        given.json.write_text(json.dumps({"format": "onset-1", "verdicts": verdicts}, indent=1) + "\n")
    bad = [cell for rows in verdicts.values() for cells in rows.values() for cell in cells.values() if cell["verdict"] in ("fail", "refused")]
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
