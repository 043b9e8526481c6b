"""Compares the time that `slipfront check` estimates for 100 runs with the processor time that they take.

    python3 benches/estimates.py target/release/slipfront

Sizes, speeds, laws and ends are drawn at random from a fixed seed, so that a run takes some seconds. Prints a
line a run: seconds, the two bounds over them, and the case; at the end how many lower bounds are below half of
the truth and how many upper ones above twice of it, of runs that are said to take a second or more; others must
take less than two. Other work on the machine does not count in either time.
"""

import json
import random
import resource
import subprocess
import sys
import tempfile

RUNS = 100
# Steps times blocks of a run: one to five seconds of one core.
BLOCK_STEPS = (1.5e8, 6e8)
KINDS = {
    "rough": [],
    "cavity": ["texture.0={shape='cavity', coverage=10}"],
    "smooth cavity": ["texture.0={shape='cavity', coverage=10}", "friction.sigma_static_star=0"],
    "dimples": ["texture.0={shape='cavity', coverage=20, array=[4, 4]}"],
    "periodic": ["slider.edges='periodic'"],
    "slip weakening": ["friction.slip_weakening={length_star=0.5}"],
    "ageing": ["friction.ageing={law='logarithmic', beta=0.02, time_star=1}"],
    "viscous": ["slider.viscosity_time_star=0.1"],
    "contact springs": ["friction.contact='springs'", "friction.contact_stiffness_star=1"],
    "soft mount": ["drive.stiffness_star=0.0375"],
}


def draw(rng: random.Random) -> tuple[str, list[str]]:
    kind = rng.choice(list(KINDS))
    blocks = rng.choice([25, 40, 64, 100, 160, 250])
    steps = rng.uniform(*BLOCK_STEPS) / blocks**2
    # The path of "auto" is 8/V*, at the stiffness of the paper's springs, in steps of 0.1.
    softer = 10 if kind == "soft mount" else 1
    v_star = min(max(80 * softer / steps, 1e-5), 1.0)
    stop = rng.choice(["end", "end", "after_onset"])
    keys = [f"slider.blocks=[{blocks},{blocks}]", f"drive.v_star={v_star:.3g}", f"time.stop='{stop}'"]
    return f"{kind}, {blocks} x {blocks}, V* = {v_star:.3g}, {stop}", keys + KINDS[kind]


def main() -> None:
    program = sys.argv[1]
    rng = random.Random(1)
    low, high = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(RUNS):
            name, keys = draw(rng)
            sets = [part for key in keys for part in ("--set", key)]
            check = subprocess.run([program, "check", "--json", *sets], capture_output=True, check=True)
            least, most = json.loads(check.stdout)["seconds"]
            began = resource.getrusage(resource.RUSAGE_CHILDREN)
            options = ["-o", folder, "--force", "--quiet", "--no-pictures", "--threads", "1"]
            subprocess.run([program, "run", *sets, *options], check=True)
            ended = resource.getrusage(resource.RUSAGE_CHILDREN)
            truth = ended.ru_utime - began.ru_utime + ended.ru_stime - began.ru_stime
            if most < 1:
                low += truth > 2
            else:
                low += least < truth / 2
                high += most > 2 * truth
            print(f"{truth:7.2f} s   {least / truth:5.2f} to {most / truth:5.2f}   {name}", flush=True)
    print(f"{low} of {RUNS} lower bounds are below half of the truth, {high} upper ones above twice of it")


if __name__ == "__main__":
    main()
