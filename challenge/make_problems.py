#!/usr/bin/env python3
"""Writes the problems of the onset challenge, one folder each:

    make_problems.py [FOLDER]

into FOLDER, `problems` beside this file if not given. Every number is the same on every machine: random surfaces are
sums of uniform numbers of Python's Mersenne twister, rounded to six decimals, and no sine or logarithm is taken.
"""

import json
import math
import random
import sys
from decimal import Decimal
from pathlib import Path

# Damping 0.1 sqrt(k1), which is that of most problems.
DAMPING = 0.1 * math.sqrt(0.75)
RATE_AND_STATE = {"a": 0.01, "b": 0.02, "d_c": 0.02, "v_0": 1e-3, "mu_0": 0.6, "theta_0": 19.8, "slip_speed": 0.1}


def plain(value):
    """A number as a plain decimal that reads back as the same double.

    >>> [plain(x) for x in (1.0, 0.75, -2.5e-7)]
    ['1', '0.75', '-0.00000025']
    """
    return format(Decimal(repr(float(value))), "f").removesuffix(".0")


def normals(seed, count):
    """Numbers of mean 0 and variance 1, nearly normal: twelve uniform ones less six, rounded to six decimals."""
    draw = random.Random(seed).random
    return [round(sum(draw() for _ in range(12)) - 6.0, 6) for _ in range(count)]


class Folder:
    """The folder of one problem."""

    def __init__(self, root, name):
        self.path = root / name
        self.path.mkdir(parents=True, exist_ok=True)
        for old in self.path.iterdir():
            old.unlink()

    def array(self, name, rows):
        """Writes rows of numbers, the first at y = 0, and answers with the name of the file."""
        text = "".join(",".join(map(plain, row)) + "\n" for row in rows)
        (self.path / name).write_text(text, encoding="ascii")
        return name

    def problem(self, title, nx, ny, **parts):
        """Writes `problem.json`: what `parts` do not say has the values of most problems."""
        lattice = {"nx": nx, "ny": ny, "k1": 0.75, "k2": 0.375, "edges": ["free", "free"], "halve_edge_springs": False,
                   "geometry": "linear", "viscosity": 0, "blocks": 1} | parts.pop("lattice", {})
        drive = {"springs": 0.375, "direction": [1, 0], "held": False, "prestress": None} | parts.pop("drive")
        friction = {"law": "coulomb", "static": 1, "kinetic": 0.5, "vector": True} | parts.pop("friction", {})
        whole = {"format": "onset-1", "id": self.path.name, "title": title, "lattice": lattice, "mass": 1,
                 "damping": parts.pop("damping", DAMPING), "drive": drive, "contact": parts.pop("contact", 1),
                 "normal": parts.pop("normal", 1), "friction": friction, "initial": {"u": None, "v": None}} | parts
        assert {"until", "step_max", "answers"} <= whole.keys()
        lines = ",\n".join(f" {json.dumps(key)}: {json.dumps(value)}" for key, value in whole.items())
        (self.path / "problem.json").write_text(f"{{\n{lines}\n}}\n", encoding="ascii")


def ramp(speed, until):
    return {"path": [[0, 0], [until, round(speed * until, 9)]]}


def grid(nx, ny, value):
    """Rows of `value(x, y)` at the middles of the blocks."""
    return [[value(i + 0.5, j + 0.5) for i in range(nx)] for j in range(ny)]


def single_block(root):
    Folder(root, "P01").problem(
        "Stick-slip of one block without damping, six cycles", 1, 1, damping=0, drive=ramp(0.03, 600), until=600,
        step_max=0.1, answers={"events": {"first": 6}})


def groove(root):
    folder = Folder(root, "P02")
    contact = grid(50, 50, lambda x, y: 0 if 23 < x < 28 else 1)
    folder.problem(
        "A groove of five columns across the drive: the first slip", 50, 50, lattice={"edges": ["periodic", "periodic"]},
        drive=ramp(0.03, 60), contact=folder.array("contact.csv", contact),
        normal=50 / 45, until=60, step_max=0.1, answers={"first_slip": {}})


def circle(root):
    folder = Folder(root, "P03")
    contact = grid(50, 50, lambda x, y: 0 if math.pi * ((x - 25) ** 2 + (y - 25) ** 2) < 250 else 1)
    touching = sum(map(sum, contact))
    folder.problem(
        "A round cavity under a tenth of an even surface", 50, 50, drive=ramp(0.03, 120),
        contact=folder.array("contact.csv", contact), normal=2500 / touching, until=120, step_max=0.1,
        answers={"first_slip": {}, "static": {"level": 0.5 + DAMPING * 0.03}, "first_slip_map": {}})


def random_surface(root):
    folder, n = Folder(root, "P04"), 25
    static, kinetic, high = (normals(seed, n * n) for seed in (401, 402, 403))
    # The lowest twelfth of the blocks touches nothing; the pressure rises along y.
    lowest = sorted(high)[n * n // 12]
    rows = [range(j * n, (j + 1) * n) for j in range(n)]
    contact = [[0 if high[b] < lowest else 1 for b in row] for row in rows]
    pressure = [[round(1 + 0.4 * (2 * (j + 0.5) / n - 1), 6)] * n for j in range(n)]
    borne = sum(p * c for both in zip(pressure, contact) for p, c in zip(*both))
    load = [[round(p * n * n / borne, 6) * c for p, c in zip(*both)] for both in zip(pressure, contact)]
    slides = [[round(0.5 * (1 + 0.05 * kinetic[b]), 6) for b in row] for row in rows]
    level = sum(k * p for both in zip(slides, load) for k, p in zip(*both)) / (n * n)
    folder.problem(
        "A random surface with blocks that touch nothing, under a pressure that rises across the drive", n, n,
        drive=ramp(0.03, 267), contact=folder.array("contact.csv", contact), normal=folder.array("normal.csv", load),
        friction={"static": folder.array("static.csv", [[round(1 + 0.05 * static[b], 6) for b in row] for row in rows]),
                  "kinetic": folder.array("kinetic.csv", slides)},
        until=267, step_max=0.1,
        answers={"first_slip": {}, "static": {"level": round(level + DAMPING * 0.03, 6)}, "kinetic": {"from": 150, "to": 267},
                 "first_slip_map": {}})


def chain_fronts(root):
    for part, tau in (("a", 0.2), ("b", 0.5), ("c", 0.9)):
        folder, force = Folder(root, f"P05{part}"), round(0.5 + 0.5 * tau, 6)
        static = folder.array("static.csv", [[round(force - 0.001, 6)] * 20 + [1] * 280])
        folder.problem(
            f"A front of slip along a chain under a dead load, prestress {tau}", 300, 1, damping=0,
            drive={"springs": 0, "path": [[0, 0], [300, 0]], "prestress": force}, friction={"static": static}, until=300,
            step_max=0.005, answers={"front": {"row": 0, "windows": [[200, 224]]}})


def precursors(root):
    folder, n, slope = Folder(root, "P06"), 100, -0.833
    load = [[round(1 + slope * (2 * (i + 0.5) / n - 1), 9) for i in range(n)]]
    springs = [[0.00242] + [0] * (n - 1)]
    folder.problem(
        "Precursors in a chain that is pulled at one end, under a pressure that falls along it", n, 1, damping=0,
        lattice={"viscosity": 0.365}, drive=ramp(1, 28000) | {"springs": folder.array("springs.csv", springs)},
        normal=folder.array("normal.csv", load), friction={"static": 1, "kinetic": round(0.45 / 0.7, 6)}, until=28000,
        step_max=0.4, answers={"events": {"longest": True}})


def line_fault(root):
    folder, nx, row = Folder(root, "P07"), 201, 50
    static = [round(1 + 0.5 * ((i - nx // 2) / 60) ** 2, 12) for i in range(nx)]
    one_row = lambda name, value: {"rows": {str(row): folder.array(name, [value]) if name else value}, "else": 0}
    folder.problem(
        "Slip weakening on a line in the middle of a sheet: nucleation", nx, 101, damping=round(0.5 * DAMPING, 9),
        drive={"springs": one_row(None, 1e-4), "path": [[0, 0], [13000, 65]], "prestress": one_row(None, 0.9995)},
        contact=one_row(None, 1), normal=one_row(None, 1),
        friction={"law": "slip_weakening", "static": one_row("static.csv", static),
                  "kinetic": one_row("kinetic.csv", [round(s - 0.5, 12) for s in static]), "length": 5},
        until=13000, step_max=0.4, answers={"first_slip_map": {"rows": [row]}})


def mode_two(root):
    nx, ny, kinetic, weakening, modulus = 600, 160, 0.5, 0.2, 1.1
    # As many windows as a front that is not too slow passes before the run ends.
    for part, strength, passed in (("a", 0.9, 7), ("b", 1.4, 5), ("c", 2.0, 4)):
        folder, force = Folder(root, f"P08{part}"), round((1 + strength * kinetic) / (1 + strength), 9)
        # Critical length of the continuum, mu_eff/(pi W) (1 + S)^2, and the weak patch, 1.3 of it on either side.
        critical = modulus / weakening * (1 + strength) ** 2 / math.pi
        static = [round(force - 0.004, 9) if abs(i - nx // 2) <= 1.3 * critical else 1 for i in range(nx)]
        first = int(1.3 * critical) + 5
        windows = [[nx // 2 + first + 25 * n, nx // 2 + first + 25 * n + 24] for n in range(passed)]
        edge = lambda value: {"rows": {"0": value}, "else": 0}
        folder.problem(
            f"Rupture along the edge of a half plane in mode II, seismic ratio {strength}", nx, ny, damping=0,
            drive={"springs": 0, "path": [[0, 0], [300, 0]], "prestress": edge(force)}, contact=edge(1), normal=edge(1),
            friction={"law": "slip_weakening", "static": edge(folder.array("static.csv", [static])), "kinetic": edge(kinetic),
                      "length": 2.5, "vector": False},
            until=300, step_max=0.25, critical_length=round(critical, 6),
            answers={"first_slip_map": {"rows": [0]}, "front": {"row": 0, "windows": windows}})


def disc(root):
    folder, n = Folder(root, "P09"), 20
    arm = grid(n, n, lambda x, y: (x - n / 2, y - n / 2))
    exists = [[1 if math.sqrt(x * x + y * y) < n / 2 else 0 for x, y in row] for row in arm]
    largest = max(math.sqrt(x * x + y * y) for both in zip(arm, exists) for (x, y), e in zip(*both) if e)
    turned = lambda part: [[part(x, y) / largest * e for (x, y), e in zip(*both)] for both in zip(arm, exists)]
    direction = [folder.array("direction_x.csv", turned(lambda x, y: -y)), folder.array("direction_y.csv", turned(lambda x, y: x))]
    folder.problem(
        "A disc that is turned about its middle", n, n, lattice={"blocks": folder.array("blocks.csv", exists)},
        drive=ramp(0.03, 150) | {"direction": direction}, until=150, step_max=0.1,
        answers={"first_slip": {}, "first_slip_force": {}, "static": {"level": 0.502}})


def rate_and_state(root):
    Folder(root, "P10").problem(
        "Stick-slip of one block under rate and state friction, with inertia", 1, 1, damping=0,
        drive=ramp(1e-3, 26000) | {"springs": 0.1}, friction={"law": "rate_and_state", "static": None, "kinetic": None} | RATE_AND_STATE,
        until=26000, step_max=0.1, answers={"period": {"from_event": 5}, "peak_speed": {"from_event": 5}})


def burridge_knopoff(root):
    folder, n = Folder(root, "P11"), 200
    static = folder.array("static.csv", [[round(1 + 0.002 * g, 6) for g in normals(1101, n)]])
    folder.problem(
        "A Burridge-Knopoff chain with friction that falls with speed: the statistics of ten thousand events", n, 1, damping=0,
        drive={"springs": 0.0075, "path": [[0, 0], [1e9, 1e8]], "held": True},
        friction={"law": "velocity_weakening", "static": static, "kinetic": 0.99, "v_c": 2.31, "ratio": 0}, until=None,
        until_events=12500, step_max=0.2,
        answers={"histogram": {"from_event": 2501, "parts": 5, "ln_moment": [-8, 8], "bins": 32}})


def design(root):
    Folder(root, "P12").problem(
        "The mask of 1250 contacts that slips at the least pull, on surfaces that are drawn after it is sent", 50, 50,
        drive=ramp(0.003, 1000), contact="mask.csv", normal=2, until=1000, step_max=0.1,
        friction={"static": "static.csv", "kinetic": 0.5},
        answers={"mask": {"touching": 1250, "spread": 0.05}, "static": {"level": 0.5 + DAMPING * 0.003}})


PROBLEMS = [single_block, groove, circle, random_surface, chain_fronts, precursors, line_fault, mode_two, disc, rate_and_state,
            burridge_knopoff, design]


def main(root):
    for write in PROBLEMS:
        write(root)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else Path(__file__).resolve().parent / "problems")
