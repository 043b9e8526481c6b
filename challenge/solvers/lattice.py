#!/usr/bin/env python3
"""The lattice of the onset challenge in NumPy: one process, whole arrays, fixed steps.

    lattice.py PROBLEM OUTPUT [--dt DT]

The scheme is leapfrog with friction of Moreau: the impulse of friction takes from the velocity that a block would have
without it as much as it can, at most all of it. A block is stuck if and only if its velocity is zero.
"""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import onset


def spans(n, shift, periodic):
    """Pairs of slices of an axis of n blocks: blocks, and their neighbours `shift` on."""
    if shift == 0:
        return [(slice(0, n), slice(0, n))]
    inner, wrapped = (slice(0, n - 1), slice(1, n)), (slice(n - 1, n), slice(0, 1))
    pairs = ([inner] if n > 1 else []) + ([wrapped] if periodic else [])
    return pairs if shift > 0 else [pair[::-1] for pair in pairs]


def bonds(p):
    """Springs between neighbours: places of both ends, stiffness, direction."""
    half = math.sqrt(0.5)
    for dx, dy, k, ex, ey in ((1, 0, p.k1, 1, 0), (0, 1, p.k1, 0, 1), (1, 1, p.k2, half, half), (-1, 1, p.k2, -half, half)):
        for here_x, there_x in spans(p.nx, dx, p.periodic[0]):
            for here_y, there_y in spans(p.ny, dy, p.periodic[1]):
                here, there = (here_y, here_x), (there_y, there_x)
                whole = p.exists[here] & p.exists[there]
                yield here, there, k if whole.all() else k * whole, ex, ey


class Catalogue:
    """Events: the longest times in which a block in contact moves."""

    def __init__(self, p):
        self.p, self.rows, self.begun = p, [], None

    def watch(self, t, moves, force, u):
        if moves and self.begun is None:
            self.begun = t, force, [part.copy() for part in u]
        elif not moves and self.begun is not None:
            began, before, was = self.begun
            moved = [now - then for now, then in zip(u, was)]
            blocks = np.count_nonzero(np.any(np.array(moved) != 0, axis=0) & self.p.contact)
            moment = sum(np.sum((g * m)[self.p.contact]) for g, m in zip(self.p.direction, moved))
            self.rows.append((began, t, blocks, moment, before, force))
            self.begun = None


def simulate(p, dt):
    """Runs a problem; answers with the record of it that `onset.answers` takes."""
    if p.law == "rate_and_state":
        return simulate_rate_and_state(p, dt)
    law, axes = p.friction, range(1 if p.ny == 1 else 2)
    grip = axes if p.vector else range(1)
    springs, driven = list(bonds(p)), bool(np.any(p.springs))
    pulled, dead = ([field * p.direction[a] for a in axes] for field in (p.springs, p.prestress))
    before, impulse = (1 - 0.5 * p.damping * dt) / (1 + 0.5 * p.damping * dt), dt / (1 + 0.5 * p.damping * dt)
    # Blocks in contact, as places in the arrays of all blocks.
    touch = ... if p.contact.all() else np.nonzero(p.contact)
    fs, fk = (p.static * p.normal)[touch], (p.kinetic * p.normal)[touch]
    u, v = ([np.zeros((p.ny, p.nx)) for _ in axes] for _ in range(2))
    slip, first = np.zeros(fs.shape), np.full(fs.shape, np.nan)
    catalogue, times, force = Catalogue(p), [], []
    n = drive_steps = 0
    stop, enough = (math.inf if p.until is None else round(p.until / dt)), p.raw.get("until_events", math.inf)
    while n <= stop and len(catalogue.rows) < enough:
        # Forces at t_n: drive, then springs and dampers between blocks.
        x = p.reach(drive_steps * dt)
        f = [dead[a] + (x * pulled[a] - p.springs * u[a]) if driven else dead[a].copy() for a in axes]
        pull = sum(np.vdot(p.direction[a], f[a]) for a in axes) / p.weight
        w = [u[a] + p.viscosity * v[a] for a in axes] if p.viscosity else u
        for here, there, k, *e in springs:
            tension = k * sum(e[a] * (w[a][there] - w[a][here]) for a in axes if e[a])
            for a in axes:
                if e[a]:
                    f[a][here] += e[a] * tension
                    f[a][there] -= e[a] * tension
        # Thresholds of the blocks in contact, and velocities without friction half a step later.
        speed = length([v[a][touch] for a in grip])
        holds, slows = thresholds(law, fs, fk, slip, speed)
        stuck = (speed == 0) & (length([f[a][touch] for a in grip]) <= holds)
        for a in axes:
            v[a] *= before
            v[a] += impulse * f[a]
        # The impulse of friction takes from them what it can.
        free = length([v[a][touch] for a in grip])
        stays = stuck | (free <= impulse * slows)
        keep = np.where(stays, 0.0, 1 - impulse * slows / np.where(stays, 1.0, free))
        for a in grip:
            v[a][touch] *= keep
        slides = ~stays
        moves = bool(slides.any())
        catalogue.watch(n * dt, moves, pull, u)
        if moves:
            first[slides & np.isnan(first)] = n * dt
            slip += dt * keep * free
        if p.until is not None:
            times.append(n * dt)
            force.append(pull)
        for a in axes:
            u[a] += dt * v[a]
        n += 1
        drive_steps += not (p.held and moves)
    whole = np.full((p.ny, p.nx), np.nan)
    whole[touch] = first
    return np.array(times), np.array(force), whole, np.array(catalogue.rows).reshape(-1, 6), None


def thresholds(law, fs, fk, slip, speed):
    """Largest friction of a block at rest, and friction of a sliding one."""
    if law["law"] == "slip_weakening":
        return 2 * [fk + (fs - fk) * np.maximum(0, 1 - slip / law["length"])]
    if law["law"] == "velocity_weakening":
        return fs, fk * (law["ratio"] + (1 - law["ratio"]) / (1 + speed / law["v_c"]))
    return fs, fk


def length(parts):
    return np.abs(parts[0]) if len(parts) == 1 else np.sqrt(parts[0] ** 2 + parts[1] ** 2)


def simulate_rate_and_state(p, dt):
    """One block on its spring, with friction at the speed half a step after its state."""
    law, load, k = p.friction, float(p.normal[0, 0]), float(p.springs[0, 0])
    a, b, d_c, v_0 = (law[key] for key in ("a", "b", "d_c", "v_0"))
    before, impulse = (1 - 0.5 * p.damping * dt) / (1 + 0.5 * p.damping * dt), dt / (1 + 0.5 * p.damping * dt)
    u, v, theta, mean = 0.0, 0.0, law["theta_0"], 0.0
    times, force, rows, speeds, begun, first, fastest = [], [], [], [], None, math.nan, 0.0
    for n in range(round(p.until / dt) + 1):
        t = n * dt
        mean = k * (p.reach(t) - u)
        free = before * v + impulse * mean
        state = math.exp((law["mu_0"] + b * math.log(v_0 * theta / d_c)) / a) / (2 * v_0)
        v = math.copysign(speed_under(abs(free), impulse * load * a, state, abs(v)), free)
        slides = abs(v) > law["slip_speed"]
        fastest = max(fastest, abs(v)) if slides else fastest
        if slides and begun is None:
            begun, first = (t, mean, u), t if math.isnan(first) else first
        elif not slides and begun is not None:
            rows.append((begun[0], t, 1, u - begun[2], begun[1], mean))
            speeds.append(fastest)
            begun, fastest = None, 0.0
        times.append(t)
        force.append(mean)
        u += dt * v
        x = abs(v) * dt / d_c
        theta = theta * math.exp(-x) + dt * (-math.expm1(-x) / x if x > 0 else 1.0)
    return np.array(times), np.array(force), np.array([[first]]), np.array(rows).reshape(-1, 6), np.array(speeds)


def speed_under(free, most, state, guess):
    """The speed v with v + most asinh(v state) = free: Newton's method, kept between 0 and `free`."""
    low, high, v = 0.0, free, min(guess, free)
    for _ in range(200):
        wrong = v + most * math.asinh(v * state) - free
        low, high = (v, high) if wrong < 0 else (low, v)
        new = v - wrong / (1 + most * state / math.hypot(1, v * state))
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - v) <= 1e-15 * free:
            return new
        v = new
    return v


if __name__ == "__main__":
    onset.solve(__doc__.splitlines()[0], "lattice.py 1", simulate)
