"""Commands that write folders, and what must become of what a power loss leaves of them."""

import glob
import json
import os
import re
import signal
import subprocess
import time

from page import save

CASE = """
[slider]
blocks = [12, 10]
[drive]
v_star = 0.1
[friction]
mu_static_field = "mu.csv"
[time]
duration_star = 60
[output]
snapshots = [30, 50]
series = 1
"""

# Long enough to be stopped by a signal.
SLOW = CASE.replace("duration_star = 60", "duration_star = 10000").replace("series = 1", "series = 100")

STUDY = """
[base.slider]
blocks = [4, 4]
[base.friction]
mu_static_field = "few.csv"
[base.time]
duration_star = 40
[base.output]
snapshots = []
series = 1
[study]
replicates = 1
keep = "all"
[[axes]]
key = "drive.v_star"
list = [0.1, 0.2]
"""

DESIGN = """
[base.slider]
blocks = [6, 6]
[base.drive]
v_star = 0.2
[base.friction]
mu_static_field = "square.csv"
[design]
wish = { least = "static_friction" }
coverage = [0, 20]
runs = 8
"""

MESHES = """
[slider]
blocks = [4, 4]
[drive]
v_star = 0.2
[time]
duration_star = 60
[output]
snapshots = []
series = 1
"""

FIT = """
base = "meshes.toml"
[calibrate]
x = "time_s"
y = "friction_force_n"
noise = 0.01
runs = 200
finer_runs = 0
[calibrate.unknowns]
"friction.mu_static" = [0.3, 0.9]
"""


def table(columns, rows):
    return "\n".join(",".join(f"{1 + (7 * row + 3 * column) % 11 / 100}" for column in range(columns)) for row in range(rows)) + "\n"


FILES = {
    "case.toml": CASE,
    "slow.toml": SLOW,
    "study.toml": STUDY,
    "design.toml": DESIGN,
    "meshes.toml": MESHES,
    "fit.toml": FIT,
    "mu.csv": table(12, 10),
    "few.csv": table(4, 4),
    "square.csv": table(6, 6),
}


class Defect(Exception):
    """A promise that was not kept for a state."""


def slipfront(program, line, folder):
    """Runs the command; returns its status and all that it has printed. It may neither panic nor fail without a sentence."""
    done = subprocess.run([program, *line.split()], cwd=folder, capture_output=True, text=True, timeout=120)
    said = done.stdout + done.stderr
    if done.returncode not in (0, 1, 2) or "panicked" in said or (done.returncode and not re.search("^error: .{20}", done.stderr, re.M)):
        raise Defect(f"`slipfront {line}` ends with {done.returncode} and says: {said}")
    return done.returncode, said


def files_below(folder):
    """Every file below a folder with its bytes."""
    found = {}
    for path, _, names in os.walk(folder):
        for name in names:
            whole = os.path.join(path, name)
            with open(whole, "rb") as file:
                found[os.path.relpath(whole, folder)] = file.read()
    return found


def without_time(files):
    """Files of results without what tells when they were made; of records of runs only their identities. The journal of a complete run in a
    study is left out: nobody looks there again, and `verify` notes it. The hash of a journal in checksums.json is one of times: `verify` is
    there to compare it."""
    kept = {}
    for name, content in files.items():
        run = re.match("(runs/[^/]+/)[.]slipfront/journal.jsonl", name)
        if run and f"{run[1]}manifest.json" in files:
            continue
        if os.path.basename(name) == "manifest.json":
            kept[name] = b"a manifest"
        elif name == "ro-crate-metadata.json":
            kept[name] = re.sub(rb'"datePublished": "20[0-9-]+"', b"", content)
        elif name == "runs.jsonl":
            kept[name] = sorted(re.findall(rb'"id":"(\w+)"', content))
        elif name == "checksums.json":
            sealed = json.loads(content)
            kept[name] = {**sealed, "seal": None, "sources": [source["name"] for source in sealed.get("sources", [])]}
        else:
            kept[name] = content
    return kept


def interrupt(strace):
    """Sends SIGINT to the command that strace has started."""
    with open(f"/proc/{strace.pid}/task/{strace.pid}/children", encoding="ascii") as file:
        os.kill(int(file.read().split()[0]), signal.SIGINT)


class Job:
    """Commands that are recorded one after the other, in a folder with these files."""

    name = ""
    before = ()
    lines = ()
    # The folder that they write.
    out = "out"

    def meanwhile(self, number, program, folder):
        """Function that is called with the process of strace while a command runs."""
        return lambda process: None

    def statuses(self):
        """The statuses with which the commands end."""
        return [130] * (len(self.lines) - 1) + [0]

    def expected(self, folder):
        """Files of the undisturbed end, by names of what they are."""
        return {"the results": without_time(files_below(os.path.join(folder, self.out)))}

    def recover(self, program, folder, expected, ended):
        """Does what a user would do with a state, and returns what became of it, in words. `ended` is the number of the command that has just
        ended, none within one."""
        raise NotImplementedError

    def right(self, program, folder, expected):
        """Name of the expected end that the folder holds; a defect if it holds none of them."""
        out = os.path.join(folder, self.out)
        found = without_time(files_below(out))
        for name, files in expected.items():
            if files == found:
                status, said = slipfront(program, f"verify {self.out}", folder)
                if status:
                    raise Defect(f"verify: {said}")
                return name
        files = next(iter(expected.values()))
        wrong = sorted(name for name in files.keys() | found.keys() if files.get(name) != found.get(name))
        raise Defect(f"these files are not as they should be: {wrong}")


class Run(Job):
    name = "run"
    lines = ("run case.toml -o out --threads 1 --no-pictures",)
    case = "case.toml"
    options = "--threads 1 --no-pictures"

    def recover(self, program, folder, expected, ended):
        status, said = slipfront(program, f"run --resume {self.out} {self.options}", folder)
        if status == 0:
            became = self.right(program, folder, expected)
            if "is complete" in said:
                return f"{became}: complete"
            at = "from a checkpoint" if "goes on from step" in said else "from the start"
            if ended is not None and (ended == len(self.lines) - 1 or at == "from the start"):
                raise Defect(f"the command had ended, and its run was resumed {at}")
            return f"{became}: resumed {at}"
        if ended is not None:
            raise Defect(f"the command had ended, and its run cannot be used: {said}")
        # The sentence tells the remedy.
        if "--previous" in said:
            remedy, line = "by --previous", f"run --resume {self.out} --previous {self.options}"
        elif "--force" in said:
            remedy, line = "begun again with --force", f"run {self.case} -o {self.out} {self.options} --force"
        elif "begin the run again" in said:
            remedy, line = "begun again", f"run {self.case} -o {self.out} {self.options}"
        else:
            raise Defect(f"a sentence without a remedy: {said}")
        status, after = slipfront(program, line, folder)
        if status:
            raise Defect(f"the remedy does not help: {said}then `slipfront {line}`: {after}")
        return f"refused, {remedy}: {self.right(program, folder, expected)}"


class Pictures(Run):
    name = "run with pictures"
    lines = ("run case.toml -o out --threads 1",)
    options = "--threads 1"


class Replaced(Run):
    """Another run stands in the folder, which gives way."""

    name = "run --force"
    before = ("run case.toml -o out --threads 1 --no-pictures --seed 2",)
    lines = ("run case.toml -o out --threads 1 --no-pictures --force",)


class Repeated(Run):
    """The run of the same case stands in the folder: what is left of it looks like what is to come."""

    name = "run --force of the same case"
    before = ("run case.toml -o out --threads 1 --no-pictures",)
    lines = ("run case.toml -o out --threads 1 --no-pictures --force",)


class Stopped(Run):
    """A run that is stopped by a signal twice, and resumed."""

    name = "run --resume"
    case = "slow.toml"
    lines = (
        "run slow.toml -o out --threads 1 --no-pictures --checkpoint 0s",
        "run --resume out --threads 1 --no-pictures --checkpoint 0s",
        "run --resume out --threads 1 --no-pictures --checkpoint 0s",
    )

    def meanwhile(self, number, program, folder):
        def stop(process):
            checkpoint = os.path.join(folder, "out/.slipfront/checkpoint.bin")
            before = os.stat(checkpoint).st_ino if os.path.exists(checkpoint) else None
            while process.poll() is None:
                time.sleep(0.001)
                if os.path.exists(checkpoint) and os.stat(checkpoint).st_ino != before:
                    break
            interrupt(process)

        return stop if number < 2 else super().meanwhile(number, program, folder)


class Study(Job):
    name = "study"
    line = "study study.toml -o out --threads 1 --quiet"
    lines = (line,)

    def recover(self, program, folder, expected, ended):
        if ended is not None:
            self.right(program, folder, expected)
        status, said = slipfront(program, self.line, folder)
        if status == 0:
            left = ", a hidden folder left in a complete run" if glob.glob(f"{folder}/out/runs/*/.slipfront") else ""
            return f"{self.right(program, folder, expected)}: done{left}"
        raise Defect(f"the same command does not go on: {said}")


class Merge(Study):
    """Two parts of a study, the run folders of which are copied."""

    name = "study merge"
    before = tuple(f"study study.toml --shard {part}/2 -o part{part} --threads 1 --quiet" for part in (1, 2))
    line = "study merge part1 part2 -o out --quiet"
    lines = (line,)


class Design(Study):
    name = "design"
    line = "design design.toml -o out --threads 1 --quiet"
    lines = (line,)

    def right(self, program, folder, expected):
        found = without_time(files_below(os.path.join(folder, self.out)))
        files = expected["the results"]
        wrong = sorted(name for name in files.keys() | found.keys() if files.get(name) != found.get(name))
        if wrong:
            raise Defect(f"these files are not as they should be: {wrong}")
        return "the results"


class Converge(Study):
    """A study over meshes, with what they found."""

    name = "converge"
    line = "converge meshes.toml -o out --replicates 2 --threads 1 --quiet"
    lines = (line,)


class Calibrate(Study):
    name = "calibrate"
    before = ("run meshes.toml -o measured --threads 1 --no-pictures",)
    line = "calibrate fit.toml measured/series.csv -o out --threads 1 --quiet"
    lines = (line,)


class Paper(Design):
    """The figure of the paper that takes the least time."""

    name = "paper"
    line = "paper fig13 -o out --threads 1 --quiet"
    lines = (line,)


class Drawn(Design):
    """Pictures of a run that are drawn by themselves."""

    name = "plot"
    before = ("run case.toml -o measured --threads 1 --no-pictures",)
    line = "plot measured -o out"
    lines = (line,)


class Exported(Design):
    """A run that is copied and described as a crate."""

    name = "export"
    before = ("run case.toml -o measured --threads 1 --no-pictures",)
    line = "export measured --ro-crate -o out"
    lines = (line,)

    def recover(self, program, folder, expected, ended):
        if ended is not None or os.path.exists(os.path.join(folder, self.out)):
            return f"{self.right(program, folder, expected)}: complete"
        status, said = slipfront(program, self.line, folder)
        if status:
            raise Defect(f"the same command does not help: {said}")
        return f"{self.right(program, folder, expected)}: done"


class Saved(Pictures):
    """A run that the laboratory saves."""

    name = "save of the laboratory"
    lines = ("lab case.toml --no-open --threads 1 --results results",)
    out = "results/out"

    def meanwhile(self, number, program, folder):
        def saves(process):
            save(process.stdout.readline(), "out")
            interrupt(process)

        return saves


JOBS = (Run, Stopped, Replaced, Repeated, Pictures, Saved, Study, Merge, Design, Converge, Calibrate, Paper, Drawn, Exported)
