#!/usr/bin/env python3
"""Simulates power losses: power_loss.py SLIPFRONT [--share S] [--keep DIR] [JOB...]

Records the writes, syncs and renames of commands (recorder.py, with strace), makes every state that a loss of power may leave on the disk
(disk.py says which), and lets slipfront go on from each: the results must be those of an undisturbed run, or a sentence must tell what to
do, and doing that gives them (jobs.py). What a command has ended with must be there whatever is lost after it. --share takes this part of
the states; --keep writes the first state that is a defect to a folder. Exit status: 1 for a defect, 2 when strace is missing.
"""

import argparse
import collections
import concurrent.futures
import copy
import os
import shutil
import sys
import tempfile

from disk import states
from jobs import FILES, JOBS, Defect, slipfront
from recorder import Recorder

JOBS_BY_NAME = {job.name: job() for job in JOBS}
MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


class TooLate(Exception):
    """A command that was not stopped before its end, or has failed."""


def fill(folder, files):
    for name, content in files.items():
        path = os.path.join(folder, name)
        if content is None:
            os.makedirs(path, exist_ok=True)
        else:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "wb") as file:
                file.write(content if isinstance(content, bytes) else content.encode())


def record(job, program):
    """The operations of a job, what the disk held before, the numbers of folders, and the files of every end that is right."""
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        work = os.path.join(folder, "work")
        fill(work, FILES)
        expected = {}
        for line in job.before:
            status, said = slipfront(program, line, work)
            if status:
                sys.exit(f"{line}: {said}")
            if os.path.isdir(os.path.join(work, job.out)):
                expected["the earlier run"] = job.expected(work)["the results"]
        recorder = Recorder(work)
        before = copy.deepcopy(recorder.tree)
        for number, line in enumerate(job.lines):
            status, out, err = recorder.run([program, *line.split()], job.meanwhile(number, program, work))
            if status != job.statuses()[number]:
                raise TooLate(f"{line} ends with {status}: {out}{err}")
        shown = recorder.tree
        for name, content in files_of(shown).items():
            with open(os.path.join(work, name), "rb") as file:
                if file.read() != content:
                    sys.exit(f"the record of {job.name} does not give {name} as it is")
        return recorder.operations, before, set(shown.folders), {**job.expected(work), **expected}


def files_of(tree, folder=0, prefix=""):
    """The files of a tree by their paths."""
    found = {}
    for name, child in tree.folders[folder].items():
        if child in tree.folders:
            found.update(files_of(tree, child, f"{prefix}{name}/"))
        else:
            found[prefix + name] = tree.data[child]
    return found


def tried(name, program, files, expected, ended):
    """Outcome of a state in words, and whether it is a defect."""
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        fill(folder, files)
        try:
            return JOBS_BY_NAME[name].recover(program, folder, expected, ended), False
        except Defect as defect:
            return str(defect), True


def simulate(job, program, share, keep, pool):
    """Tries the states of a job; returns the number of defects."""
    for attempt in range(5):
        try:
            operations, before, folders, expected = record(job, program)
            break
        except TooLate as late:
            if attempt == 4:
                sys.exit(str(late))
    running, count, became, defects = {}, 0, collections.Counter(), 0

    def take(done):
        nonlocal defects
        for future in done:
            issued, words, files = running.pop(future)
            outcome, is_defect = future.result()
            if not is_defect:
                became[outcome] += 1
                continue
            defects += 1
            if defects <= 5:
                print(f"  DEFECT after operation {issued} of {len(operations)}, {short(operations[issued - 1])}; {words}:\n    {outcome}")
            if keep and defects == 1:
                shutil.rmtree(keep, ignore_errors=True)
                fill(keep, files)

    ends = [number + 1 for number, one in enumerate(operations) if one[0] == "end"]
    for issued, words, files in states(operations, before, folders):
        count += 1
        ended = ends.index(issued) if issued in ends else None
        # The ends are tried in any case.
        if ended is None and int(count * share) == int((count - 1) * share):
            continue
        future = pool.submit(tried, job.name, program, files, expected, ended)
        running[future] = issued, words, files
        if len(running) > 8:
            take(concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED).done)
    take(concurrent.futures.wait(running).done)
    kinds = collections.Counter(one[0] for one in operations)
    told = ", ".join(f"{number} {kind}" for kind, number in sorted(kinds.items()) if kind not in ("say", "end"))
    print(f"{job.name}: {len(operations)} operations ({told}), {count} states, {sum(became.values()) + defects} tried, {defects} defects")
    for outcome, number in sorted(became.items()):
        print(f"  {number:6} {outcome}")
    sys.stdout.flush()
    return defects


def short(operation):
    return tuple(one if not isinstance(one, bytes) else f"{len(one)} bytes" for one in operation)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("slipfront", type=os.path.abspath)
    parser.add_argument("jobs", nargs="*", choices=[*JOBS_BY_NAME, []])
    parser.add_argument("--share", type=float, default=1.0)
    parser.add_argument("--keep")
    given = parser.parse_args()
    if shutil.which("strace") is None:
        print("NOT CHECKED: strace is missing", file=sys.stderr)
        return 2
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        jobs = [JOBS_BY_NAME[name] for name in given.jobs or JOBS_BY_NAME]
        return 1 if sum(simulate(job, given.slipfront, given.share, given.keep, pool) for job in jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
