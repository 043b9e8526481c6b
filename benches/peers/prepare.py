"""Draws the input of all programs once.

    prepare.py SIZE FOLDER

writes into FOLDER the surface of SIZE x SIZE blocks, Gaussian local coefficients, as mu_s.npy and mu_k.npy for the
command `slipfront` and as mu_s.f64 and mu_k.f64 (little-endian doubles, row by row from y = 0) for the others; and
for LAMMPS, which has no friction to set anything going unevenly, a lattice of which every block starts with a
velocity of its own: lattice.data, and these velocities as kick.npy.
"""

import sys
from pathlib import Path

import numpy as np

from lattice import DAMPING, EPSILON, K_DRIVE, V_STAR

SEED = 1


def main(size, folder):
    random = np.random.default_rng(SEED)
    mu_static, mu_kinetic, *kick = (random.standard_normal((size, size)) for _ in range(4))
    # Of the order of the speeds at which blocks slip.
    kick = 0.1 * np.stack(kick)
    folder.mkdir(parents=True, exist_ok=True)
    for name, mean, normal in [("mu_s", 1.0, mu_static), ("mu_k", 0.5, mu_kinetic)]:
        field = np.maximum(mean + 0.05 * mean * normal, 0.0)
        np.save(folder / f"{name}.npy", field)
        field.astype("<f8").tofile(folder / f"{name}.f64")
    np.save(folder / "kick.npy", kick)
    write_lattice(folder / "lattice.data", size, kick)


def write_lattice(path, size, kick):
    """The data file for lattice.lmp, where the frame and the units are explained."""
    block = 1 + np.arange(size * size).reshape(size, size)
    straight = [(block[:, :-1], block[:, 1:]), (block[:-1, :], block[1:, :])]
    diagonal = [(block[:-1, :-1], block[1:, 1:]), (block[:-1, 1:], block[1:, :-1])]
    bonds = [
        (kind, here, there)
        for kind, pairs in [(1, straight), (2, diagonal)]
        for first, second in pairs
        for here, there in zip(first.ravel(), second.ravel())
    ]
    j, i = np.divmod(np.arange(size * size), size)
    velocity = EPSILON * (kick.reshape(2, -1) - np.array([[V_STAR], [0.0]]))
    with path.open("w") as out:
        out.write(f"slider of {size} x {size} blocks\n\n")
        out.write(f"{size * size} atoms\n1 atom types\n{len(bonds)} bonds\n2 bond types\n\n")
        out.write(f"-1 {size} xlo xhi\n-1 {size} ylo yhi\n-0.5 0.5 zlo zhi\n\n")
        out.write("Atoms\n\n")
        out.writelines(f"{b} 1 1 {x} {y} 0\n" for b, x, y in zip(block.ravel(), i, j))
        out.write("\nVelocities\n\n")
        out.writelines(f"{b} {vx:.17g} {vy:.17g} 0\n" for b, vx, vy in zip(block.ravel(), *velocity))
        out.write("\nBonds\n\n")
        out.writelines(f"{n} {kind} {here} {there}\n" for n, (kind, here, there) in enumerate(bonds, 1))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
