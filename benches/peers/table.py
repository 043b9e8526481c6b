"""Checks that all programs agree, and prints how their times compare.

    table.py RESULTS

A line of RESULTS is: size, program, mu_s*, step of the peak, nanoseconds per block and step; tabs between them, and
- for what there is not. Fails, after the table, when mu_s* or its step is not slipfront's.
"""

import sys
from collections import defaultdict
from statistics import median

# mu_s* of these programs is the same but for rounding, some 1e-15: it is a mean of displacements that are
# sums of hundreds of increments, and friction damps what differs. Springs for small displacements only, the
# slightest change of the model there is, move it by 1e-11 to 1e-10. Between the two:
TOLERANCE = 1e-12


def main(path):
    times, peaks = defaultdict(lambda: defaultdict(list)), defaultdict(lambda: defaultdict(set))
    with open(path) as lines:
        for line in lines:
            size, program, mu, step, nanoseconds = line.rstrip("\n").split("\t")
            peaks[size][program] |= {(float(mu), int(step))} if mu != "-" else set()
            times[size][program] += [float(nanoseconds)] if nanoseconds != "-" else []

    print("Nanoseconds per block and step, and how many times those of slipfront:\n")
    print("| blocks | program | mu_s* | off by | best | median | ratio of the best | of the medians |")
    print("|---|---|---|---|---|---|---|---|")
    wrong = []
    for size in times:
        our_times = times[size]["slipfront"]
        our_mu, our_step = min(peaks[size]["slipfront"])
        for program, found in peaks[size].items():
            off = max((abs(mu - our_mu) for mu, _ in found), default=None)
            if any(not abs(mu - our_mu) <= TOLERANCE or step != our_step for mu, step in found):
                wrong.append(f"{program}, {size} x {size} blocks: {found}, not {our_mu} in step {our_step}")
            row = [f"{size} x {size}", program]
            row += ["-", "-"] if off is None else [f"{min(found)[0]:.12f}", f"{off:.0e}"]
            mine = times[size][program]
            row += [f"{f(mine):.2f}" if mine else "-" for f in (min, median)]
            row += [f"{f(mine) / f(our_times):.2f}" if mine else "-" for f in (min, median)]
            print("|", " | ".join(row), "|")
    if wrong:
        sys.exit(f"\nmu_s* is off by more than {TOLERANCE:.0e}, or in another step:\n" + "\n".join(wrong))


if __name__ == "__main__":
    main(sys.argv[1])
