"""Holds LAMMPS, which has no friction, against two answers without friction.

    check_lammps.py SIZE FOLDER POSITIONS STEPS

POSITIONS is what lattice.lmp writes after STEPS steps from FOLDER/lattice.data. Fails when it is too far from either.
"""

import sys
from pathlib import Path

import numpy as np

from lattice import DAMPING, DT, EPSILON, K_DRIVE, V_STAR, run_numba


def main(size, folder, positions, steps):
    kick = np.load(folder / "kick.npy")
    time = steps * DT
    drag = DAMPING * V_STAR / K_DRIVE

    # Back from the frame and the units of lattice.lmp.
    number, x, y = np.loadtxt(positions, skiprows=9).T
    if not np.array_equal(number, np.arange(1, size * size + 1)):
        sys.exit(f"{positions} does not hold {size * size} blocks in their order")
    j, i = np.divmod(np.arange(size * size), size)
    ux = (V_STAR * time - drag + (x - i) / EPSILON).reshape(size, size)
    uy = ((y - j) / EPSILON).reshape(size, size)

    # Every block: the Numba program with friction 0. At t = 0 damping is the only force, so that the velocity
    # half a step earlier follows from the kick. LAMMPS holds positions, and rounds them by spacing(size)/2 in
    # every step; of that some 2/(Omega dt) = 230 steps are remembered, which add up to sqrt(230) roundings,
    # times 4 or 5 for the worst of many blocks. Springs off by 1 % would give 1e-3.
    zero = np.zeros((size, size))
    state = [zero.copy(), zero.copy(), *(kick / (1 - 0.5 * DAMPING * DT))]
    run_numba(zero, zero, steps, *state)
    judge(
        "every block",
        max(np.abs(ux - state[0]).max(), np.abs(uy - state[1]).max()),
        0.5 * np.spacing(float(size)) / EPSILON * np.sqrt(230) * 5,
    )

    # The slider as a whole: e = V t - mean(u) obeys e'' + Omega e' + k_s e = Omega V, e(0) = 0, e'(0) = V -
    # mean(kick). The scheme is of second order: its frequency is off by (omega dt)^2/24, its amplitude by
    # (omega dt)^2/8.
    omega = np.sqrt(K_DRIVE - DAMPING**2 / 4)
    a, b = -drag, (V_STAR - kick[0].mean() - 0.5 * DAMPING * drag) / omega
    decay = np.exp(-0.5 * DAMPING * time)
    e = drag + decay * (a * np.cos(omega * time) + b * np.sin(omega * time))
    judge(
        "the whole slider",
        abs(ux.mean() - (V_STAR * time - e)),
        decay * np.hypot(a, b) * (omega * DT) ** 2 * (omega * time / 24 + 1 / 8),
    )


def judge(what, difference, tolerance):
    print(f"LAMMPS without friction, {what}: off by {difference:.1e}, allowed {tolerance:.1e}")
    if not difference <= tolerance:
        sys.exit("LAMMPS differs")


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], int(sys.argv[4]))
