"""The search of `slipfront design` beside random drafts, optuna's TPE and CMA-ES, on the same runs.

Called by run.sh; README.md says what is compared.
"""

import argparse
import sys
from collections.abc import Callable, Iterator

import cmaes
import numpy as np
import numpy.typing as npt
import optuna
import scipy.ndimage
import slipfront as sf

BLOCKS = 50
COVERAGE = 10.0
WIDTH = 3
RECTANGLES = 3
# Centre, length, width and angle of each, from 0 to 1.
PARAMETERS = 5 * RECTANGLES
# Of each search the best so many are tried on several surfaces with the step of the case, as its own does;
# the best of these counts.
FINALISTS = 8
REFINED_SURFACES = 4
FRESH_SURFACES = 64
# The seed of fresh surfaces, far from those of the searches.
FRESH_SEED = 1001
# Textures that the own search is asked for at a time: it learns from the losses of as many.
ASKED = 8
# Points of reduction by which another search may be better.
ALLOWED = 0.1
# What a search that takes no infinite loss is told of a draft without a legal texture.
ILLEGAL = 2.0

Mask = npt.NDArray[np.bool_]
Drafts = Callable[[sf.Design, "Runs", int], None]


class Runs:
    """The runs of a search: each texture is one. What is asked for at once is run, also where it is more than what is left."""

    def __init__(self, design: sf.Design, most: int, threads: int) -> None:
        self.design, self.left, self.threads = design, most, threads
        self.found: dict[bytes, tuple[float, Mask]] = {}

    def losses(self, masks: list[Mask]) -> list[float]:
        """The losses of legal textures, on one surface with a coarse step."""
        self.left -= len(masks)
        losses = self.design.evaluate(masks, threads=self.threads)
        self.found.update({mask.tobytes(): (loss, mask) for mask, loss in zip(masks, losses, strict=True)})
        return losses

    def best(self) -> Mask:
        """The best of the finalists."""
        finalists = [mask for _, mask in sorted(self.found.values(), key=lambda found: found[0])[:FINALISTS]]
        losses = self.design.evaluate(finalists, surfaces=REFINED_SURFACES, coarse=False, threads=self.threads)
        return finalists[int(np.argmin(losses))]


def opened(mask: Mask) -> Mask:
    """The part of a set that squares of the given width within it cover; squares end at the edges of the slider."""
    return np.asarray(scipy.ndimage.binary_opening(mask, np.ones((WIDTH, WIDTH))), dtype=np.bool_)


def texture(design: sf.Design, parameters: npt.NDArray[np.float64]) -> Mask | None:
    """The largest legal texture that rectangles hold when they grow, all alike; None if there is none."""
    y, x = np.mgrid[:BLOCKS, :BLOCKS] + 0.5
    growth = np.full((BLOCKS, BLOCKS), np.inf)
    for center_x, center_y, length, width, angle in np.reshape(parameters, (RECTANGLES, 5)):
        cos, sin = np.cos(np.pi * angle), np.sin(np.pi * angle)
        dx, dy = x - BLOCKS * center_x, y - BLOCKS * center_y
        along, across = np.abs(cos * dx + sin * dy), np.abs(cos * dy - sin * dx)
        # The longest is the diagonal; a width is at most that of all that may be covered.
        half_length, half_width = 0.7 * BLOCKS * length, 0.05 * BLOCKS * width
        growth = np.minimum(growth, np.maximum(along - half_length, across - half_width).round(6))
    levels = np.unique(growth)
    low, high, largest = 0, len(levels), None
    while low < high:
        middle = (low + high) // 2
        mask = ~opened(~opened(growth <= levels[middle]))
        if 100 * mask.mean() <= COVERAGE:
            low, largest = middle + 1, mask
        else:
            high = middle
    return largest if largest is not None and largest.any() and design.illegal(largest) is None else None


def own(design: sf.Design, runs: Runs, _: int) -> None:
    """Asks the search of the design."""
    while runs.left > 0:
        masks = design.ask(min(ASKED, runs.left))
        design.tell(masks, runs.losses(masks))


def drawn(design: sf.Design, runs: Runs, seed: int) -> None:
    """Random drafts."""
    draws = np.random.default_rng(seed)
    while runs.left > 0:
        masks = [texture(design, draws.random(PARAMETERS)) for _ in range(32)]
        runs.losses([mask for mask in masks if mask is not None][: runs.left])


def tpe(design: sf.Design, runs: Runs, seed: int) -> None:
    """Optuna's TPE, which takes an infinite loss."""
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed, multivariate=True))
    while runs.left > 0:
        trial = study.ask()
        mask = texture(design, np.array([trial.suggest_float(f"p{k}", 0, 1) for k in range(PARAMETERS)]))
        study.tell(trial, float("inf") if mask is None else runs.losses([mask])[0])


def cma(design: sf.Design, runs: Runs, seed: int) -> None:
    """CMA-ES, which begins again elsewhere when it has come to an end."""
    draws = np.random.default_rng(seed)
    bounds = np.tile([0.0, 1.0], (PARAMETERS, 1))
    while runs.left > 0:
        optimizer = cmaes.CMA(draws.random(PARAMETERS), 0.3, bounds=bounds, seed=int(draws.integers(2**31)))
        while runs.left > 0 and not optimizer.should_stop():
            asked = [optimizer.ask() for _ in range(optimizer.population_size)]
            masks = [texture(design, parameters) for parameters in asked]
            losses: Iterator[float] = iter(runs.losses([mask for mask in masks if mask is not None]))
            optimizer.tell([(p, ILLEGAL if mask is None else next(losses)) for p, mask in zip(asked, masks, strict=True)])


SEARCHES: dict[str, Drafts] = {"slipfront design": own, "random drafts": drawn, "optuna TPE": tpe, "CMA-ES": cma}


def design_of(sigma: float, seed: int, start: int) -> sf.Design:
    case = {
        "slider": {"blocks": [BLOCKS, BLOCKS]},
        "drive": {"v_star": 0.03},
        "friction": {"sigma_static_star": sigma, "seed": seed},
    }
    wish = sf.Least("static_friction")
    return sf.Design(case, wish, (0, COVERAGE), feature_blocks=WIDTH, gap_blocks=WIDTH, start=start)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("starts", nargs="*", type=int, help="numbers that searches begin with; 1 to 20 unless given")
    parser.add_argument("--runs", type=int, default=600, help="runs of a search")
    parser.add_argument("--sigma", type=float, default=0.05, help="scatter of the static coefficients, sigma_s*")
    parser.add_argument("--threads", type=int, help="runs at once")
    given = parser.parse_args()
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    starts = given.starts or range(1, 21)
    fresh = design_of(given.sigma, FRESH_SEED, 1)
    reductions: dict[str, list[float]] = {name: [] for name in SEARCHES}
    for start in starts:
        for name, search in SEARCHES.items():
            design = design_of(given.sigma, 1, start)
            runs = Runs(design, given.runs, given.threads)
            search(design, runs, start)
            loss = fresh.evaluate([runs.best()], surfaces=FRESH_SURFACES, coarse=False, threads=given.threads)[0]
            reductions[name].append(100 * (1 - loss))
        print(f"start {start}:", ", ".join(f"{name} {found[-1]:.2f} %" for name, found in reductions.items()), flush=True)
    print("\n| search | mean reduction, % | deviation | least | largest |\n|---|---|---|---|---|")
    for name, found in reductions.items():
        deviation = np.std(found, ddof=1) if len(found) > 1 else float("nan")
        print(f"| {name} | {np.mean(found):.2f} | {deviation:.2f} | {min(found):.2f} | {max(found):.2f} |")
    own_mean, *others = (float(np.mean(found)) for found in reductions.values())
    print(f"\nThe own search is {own_mean - max(others):+.2f} points from the best other one.")
    return 0 if own_mean >= max(others) - ALLOWED else 1


if __name__ == "__main__":
    sys.exit(main())
