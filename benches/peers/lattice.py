"""The slider of docs/model.md in NumPy and in Numba, on one thread.

    lattice.py numpy|numba SIZE MU_STATIC.f64 MU_KINETIC.f64 STEPS

The files hold one double per block, row by row from y = 0. Prints mu_s*, the step of the peak and nanoseconds per
block and step of the loop alone, without the time that Numba takes to compile.
"""

import sys
import time

import numba
import numpy as np

# The baseline: Fig. 3 of the paper, in scaled units.
V_STAR = 0.03
EPSILON = 1e-6
DT = 0.1
K_STRAIGHT, K_DIAGONAL, K_DRIVE = 0.75, 0.375, 0.375
DAMPING = 0.1 * 0.75**0.5
# Damping centred in time: v(t + dt/2) = BEFORE v(t - dt/2) + IMPULSE F(t).
BEFORE = (1 - 0.5 * DAMPING * DT) / (1 + 0.5 * DAMPING * DT)
IMPULSE = DT / (1 + 0.5 * DAMPING * DT)


def watch(peak, level, step, mu):
    """The first peak of mu* that is followed by a fall of at least half-way to the steady level.

    `peak` is its height, its step and whether the fall has been seen, as known by now; the answer is the same anew.
    """
    height, at, ended = peak
    if not ended and mu > height:
        return mu, step, False
    return height, at, ended or (height > level and mu <= 0.5 * (height + level))


# A bond: its blocks and their neighbours as parts of an array, rest vector, stiffness, rest length.
ALL, FIRST, LAST = slice(None), slice(None, -1), slice(1, None)
BONDS = [
    ((ALL, FIRST), (ALL, LAST), 1, 0, K_STRAIGHT, 1.0),
    ((FIRST, ALL), (LAST, ALL), 0, 1, K_STRAIGHT, 1.0),
    ((FIRST, FIRST), (LAST, LAST), 1, 1, K_DIAGONAL, 2**0.5),
    ((FIRST, LAST), (LAST, FIRST), -1, 1, K_DIAGONAL, 2**0.5),
]


def run_numpy(hold, slide, steps, ux, uy, vx, vy):
    """Steps the slider on, in whole arrays; answers with the peak."""
    level = slide.mean() + DAMPING * V_STAR
    peak = (-np.inf, 0, False)
    for step in range(steps):
        reach = V_STAR * (step * DT)
        peak = watch(peak, level, step, K_DRIVE * (reach - ux.mean()))
        # Eq. 2: the springs that drive the blocks.
        fx = K_DRIVE * (reach - ux)
        fy = -K_DRIVE * uy
        # Eq. 3: the springs between blocks, exact at any strain.
        for here, there, dx, dy, k, d in BONDS:
            ex, ey = ux[there] - ux[here], uy[there] - uy[here]
            rx, ry = dx + EPSILON * ex, dy + EPSILON * ey
            r = np.sqrt(rx * rx + ry * ry)
            tension = k * (2 * (dx * ex + dy * ey) + EPSILON * (ex * ex + ey * ey)) / (r * (r + d))
            gx, gy = tension * rx, tension * ry
            fx[here] += gx
            fy[here] += gy
            fx[there] -= gx
            fy[there] -= gy
        # Eqs. 4 to 8: friction with memory (a block is stuck if and only if its velocity is zero), damping,
        # the step.
        stays = (vx == 0) & (vy == 0) & (fx * fx + fy * fy <= hold * hold)
        free_x, free_y = BEFORE * vx + IMPULSE * fx, BEFORE * vy + IMPULSE * fy
        speed = np.sqrt(free_x * free_x + free_y * free_y)
        q = IMPULSE * slide
        rests = stays | (speed <= q)
        keep = np.where(rests, 0.0, 1 - q / np.where(rests, 1.0, speed))
        np.multiply(keep, free_x, out=vx)
        np.multiply(keep, free_y, out=vy)
        ux += DT * vx
        uy += DT * vy
    return peak


# Divisions give inf and nan as in C, instead of a check and an exception each.
compiled = numba.njit(error_model="numpy")
watch_compiled = compiled(watch)


@compiled
def springs(ux, uy, fx, fy, di, dj, k):
    """Eq. 3 for the springs from every block to the one di columns and dj rows on."""
    ny, nx = ux.shape
    first, last = max(0, -di), nx - max(0, di)
    d = np.sqrt(float(di * di + dj * dj))
    # The forces of a row are kept apart until they are added: a loop that wrote to two places at once would
    # not be vectorised.
    gx, gy = np.empty(nx), np.empty(nx)
    for j in range(ny - dj):
        for i in range(first, last):
            ex, ey = ux[j + dj, i + di] - ux[j, i], uy[j + dj, i + di] - uy[j, i]
            rx, ry = di + EPSILON * ex, dj + EPSILON * ey
            r = np.sqrt(rx * rx + ry * ry)
            tension = k * (2 * (di * ex + dj * ey) + EPSILON * (ex * ex + ey * ey)) / (r * (r + d))
            gx[i] = tension * rx
            gy[i] = tension * ry
        for i in range(first, last):
            fx[j, i] += gx[i]
            fy[j, i] += gy[i]
        for i in range(first, last):
            fx[j + dj, i + di] -= gx[i]
            fy[j + dj, i + di] -= gy[i]


@compiled
def advance(hold, slide, ux, uy, vx, vy, fx, fy):
    """Eqs. 4 to 8 for every block."""
    ny, nx = ux.shape
    for j in range(ny):
        for i in range(nx):
            stuck = (vx[j, i] == 0) & (vy[j, i] == 0)
            stays = stuck & (fx[j, i] ** 2 + fy[j, i] ** 2 <= hold[j, i] ** 2)
            free_x, free_y = BEFORE * vx[j, i] + IMPULSE * fx[j, i], BEFORE * vy[j, i] + IMPULSE * fy[j, i]
            speed = np.sqrt(free_x**2 + free_y**2)
            q = IMPULSE * slide[j, i]
            keep = 0.0 if stays | (speed <= q) else 1 - q / speed
            vx[j, i] = keep * free_x
            vy[j, i] = keep * free_y
            ux[j, i] += DT * vx[j, i]
            uy[j, i] += DT * vy[j, i]


@compiled
def run_numba(hold, slide, steps, ux, uy, vx, vy):
    """The step of the lattice in plain loops, compiled."""
    level = slide.mean() + DAMPING * V_STAR
    peak = (-np.inf, 0, False)
    fx, fy = np.empty_like(ux), np.empty_like(uy)
    for step in range(steps):
        reach = V_STAR * (step * DT)
        peak = watch_compiled(peak, level, step, K_DRIVE * (reach - ux.mean()))
        for j in range(ux.shape[0]):
            for i in range(ux.shape[1]):
                fx[j, i] = K_DRIVE * (reach - ux[j, i])
                fy[j, i] = -K_DRIVE * uy[j, i]
        springs(ux, uy, fx, fy, 1, 0, K_STRAIGHT)
        springs(ux, uy, fx, fy, 0, 1, K_STRAIGHT)
        springs(ux, uy, fx, fy, 1, 1, K_DIAGONAL)
        springs(ux, uy, fx, fy, -1, 1, K_DIAGONAL)
        advance(hold, slide, ux, uy, vx, vy, fx, fy)
    return peak


def main(program, size, mu_static, mu_kinetic, steps):
    run = {"numpy": run_numpy, "numba": run_numba}[program]
    size, steps = int(size), int(steps)
    hold, slide = (np.fromfile(path, "<f8").reshape(size, size) for path in (mu_static, mu_kinetic))
    at_rest = [np.zeros((size, size)) for _ in range(4)]
    # Compiles, and does nothing else.
    run(hold, slide, 0, *at_rest)
    began = time.perf_counter()
    height, at, ended = run(hold, slide, steps, *at_rest)
    nanoseconds = 1e9 * (time.perf_counter() - began)
    if not ended:
        sys.exit(f"no transition within {steps} steps")
    print(f"{height:.17g} {at} {nanoseconds / (size * size * steps):.4f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
