#!/usr/bin/env python3
"""Holds what slipfront computes on each platform that can be run here to the hashes in tests/platforms/references.txt:

    tests/platforms/run.py PLATFORM...           cases cut to 500 steps, and a study
    tests/platforms/run.py --full PLATFORM...    cases to their end and the exact answers of the family as well
    tests/platforms/run.py --pin                 writes the hashes anew, with the widest vectors of this processor

PLATFORM is baseline (SSE2), AVX2, AVX-512, aarch64 (qemu-aarch64), windows (wine64) or wasm (Node.js); without one all are taken. Hashes are
of all files that a run, a study and the family leave but manifests, lists of checksums and journals, which hold times, places and programs, and of the pictures of one
case. --table writes the outcome to docs/reliability.md. --program FILE names another program than release/build.sh made.

Needs the programs of release/build.sh (linux-x86_64, linux-aarch64, windows-x86_64) and, for another platform than this machine, the
emulator in parentheses; for wine also mingw-w64. Exit status: 1 if a hash differs, 2 if a platform cannot be tried.
"""

import argparse
import base64
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "tests/platforms"
REFERENCES = HERE / "references.txt"
WORK = ROOT / "target/platforms"
PAGE = ROOT / "docs/reliability.md"
VERSION = re.search(r'(?m)^version = "(.*)"$', (ROOT / "Cargo.toml").read_text())[1]
STEPS = 500
# The case whose pictures are drawn too.
DRAWN = "circle"
PICTURES = [".png", ".svg"]
# They hold times, places and the order in which runs ended.
NOT_HASHED = {"manifest.json", "checksums.json", "runs.jsonl"}
BEGIN, END = "<!-- written by tests/platforms/run.py -->\n", "<!-- end -->\n"


def fail(sentence):
    """Ends with a sentence that says why a platform cannot be tried."""
    print(f"error: {sentence}", file=sys.stderr)
    sys.exit(2)


def built(name, program):
    """The program that release/build.sh has made for a platform."""
    path = ROOT / f"target/dist-stage/slipfront-{VERSION}-{name}" / program
    if not path.is_file():
        fail(f"{path} is missing: make it by release/build.sh {name}")
    return path


def tool(name, package):
    """A program of the system."""
    return shutil.which(name) or fail(f"{name} is missing: apt-get install {package}")


class Native:
    """The command on this machine, with vectors of a certain width."""

    def __init__(self, simd, program):
        self.title = f"Linux, x86-64, {'SSE2' if simd == 'baseline' else simd}"
        self.how = "this machine"
        self.line = [program or built("linux-x86_64", "slipfront")]
        self.environment = {"SLIPFRONT_SIMD": simd}
        self.is_emulated = False


class Aarch64:
    """The command for Arm, under qemu."""

    def __init__(self, program):
        self.title = "Linux, aarch64, NEON"
        emulator = tool("qemu-aarch64", "qemu-user")
        self.how = version_of([emulator, "--version"], r"version ([\d.]+)", "qemu-user")
        self.line = [emulator, program or built("linux-aarch64", "slipfront")]
        self.environment = {}
        self.is_emulated = True


class Windows:
    """The command for Windows, under wine."""

    def __init__(self, program):
        wine = tool("wine64", "wine64") if shutil.which("wine64") else tool("/usr/lib/wine/wine64", "wine64")
        folder = WORK / "windows"
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(program or built("windows-x86_64", "slipfront.exe"), folder / "slipfront.exe")
        # A library that Windows has had since 10 and wine 8 has not: its one function, by another one of
        # Windows.
        compiler = tool("x86_64-w64-mingw32-gcc", "gcc-mingw-w64-x86-64")
        library = folder / "bcryptprimitives.dll"
        subprocess.run([compiler, "-shared", "-O1", "-o", library, HERE / "bcryptprimitives.c", "-ladvapi32"], check=True)
        self.line = [wine, folder / "slipfront.exe"]
        self.environment = {"WINEPREFIX": str(WORK / "wine"), "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml="}
        # Services of wine last as long as any process of it, and inherit the pipes of the command that starts
        # them, which would be waited for.
        quiet = {"env": {**os.environ, **self.environment}, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.lasting = subprocess.Popen([wine, "cmd"], stdin=subprocess.PIPE, **quiet)
        subprocess.run([wine, "cmd", "/c", "ver"], check=True, **quiet)
        # Windows has no /proc: of this machine, the program sees the checkout alone.
        drives = WORK / "wine/dosdevices"
        (drives / "z:").unlink(missing_ok=True)
        if not (drives / "w:").is_symlink():
            (drives / "w:").symlink_to(ROOT)
        self.how = version_of([wine, "--version"], r"wine-([\d.]+)", "wine", self.environment)
        self.title = version_of([*self.line, "--version"], r"vectors: (\S+)", "Windows, x86-64,", self.environment)
        self.is_emulated = True


class Wasm:
    """The session of the laboratory, in Node.js."""

    def __init__(self):
        self.title = "WebAssembly, vectors of 128 bits"
        self.node = tool("node", "nodejs")
        self.how = version_of([self.node, "--version"], r"v([\d.]+)", "Node.js")
        self.is_emulated = True
        if not (ROOT / "target/slipfront.wasm").is_file():
            fail("target/slipfront.wasm is missing: make it by crates/slipfront-wasm/build.sh")


def version_of(line, pattern, name, environment=None):
    """A name with what a command says of its version."""
    said = subprocess.run(line, capture_output=True, text=True, env={**os.environ, **(environment or {})}).stdout
    return f"{name} {re.search(pattern, said)[1]}"


def platform(name, program):
    """A platform by its name."""
    if name == "aarch64":
        return Aarch64(program)
    if name == "windows":
        return Windows(program)
    if name == "wasm":
        return Wasm()
    return Native(name, program)


def cut(text):
    """The text of a case that ends after some steps of its time step.

    >>> print(cut('[time]\\nstep = 0.5\\nduration_star = 9 # long\\n[slider]\\n'), end="")
    [time]
    duration_star = 250
    step = 0.5
    [slider]
    >>> print(cut('[slider]\\nblocks = [2, 2]\\n'), end="")
    [slider]
    blocks = [2, 2]
    [time]
    duration_star = 50
    """
    step = re.search(r"(?m)^step = ([\d.]+)", text)
    line = f"duration_star = {STEPS * float(step[1] if step else 0.1):g}\n"
    text = re.sub(r"(?m)^(duration_star|kinetic_from_star) = .*\n", "", text)
    if "[time]\n" in text:
        return text.replace("[time]\n", f"[time]\n{line}")
    return f"{text}[time]\n{line}"


def cases(is_cut):
    """The folder of all cases, as they are or cut."""
    if not is_cut:
        return ROOT / "cases"
    folder = WORK / "cases"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for path in (ROOT / "cases").iterdir():
        if path.suffix == ".toml":
            (folder / path.name).write_text(cut(path.read_text()))
        elif path.is_file():
            shutil.copy(path, folder)
    return folder


def digest(contents):
    """Sixteen digits of the SHA-256 of some bytes."""
    return hashlib.sha256(contents).hexdigest()[:16]


def without_identity(name, contents):
    """Contents of a file; of the table of a study without the identities of runs, which follow from the sources of slipfront."""
    return re.sub(rb",[0-9a-f]{12},(done|failed),", rb",\1,", contents) if name == "runs.csv" else contents


def hashes(files):
    """One line that tells the hash of every file, given names and contents."""
    told = {name: digest(without_identity(name, contents)) for name, contents in files if Path(name).name not in NOT_HASHED}
    return " ".join(f"{name} {told[name]}" for name in sorted(told))


def hashes_of_folder(folder):
    """One line that tells the hash of every file below a folder."""
    paths = [path for path in folder.rglob("*") if path.is_file()]
    return hashes((path.relative_to(folder).as_posix(), path.read_bytes()) for path in paths)


def command(on, *arguments):
    """Runs the command of a platform."""
    line = [*on.line, *arguments]
    ran = subprocess.run(line, capture_output=True, text=True, env={**os.environ, **on.environment}, stdin=subprocess.DEVNULL)
    if ran.returncode:
        fail(f"`{' '.join(map(str, line))}` fails:\n{ran.stdout}{ran.stderr}")


def run_by_command(on, folder, out, only):
    """Hashes of all cases of a folder, run by the command."""
    found = {}
    for path in sorted(folder.glob("*.toml")):
        if only and path.stem not in only:
            continue
        # The folder is named as the case is: relative, since wine has other names for it.
        target = Path(os.path.relpath(out / path.stem))
        pictures = [] if path.stem == DRAWN else ["--no-pictures"]
        command(on, "run", os.path.relpath(path), "--out", target, "--threads", "2", "--quiet", *pictures)
        found[path.stem] = hashes_of_folder(target)
        command(on, "verify", target)
        shutil.rmtree(target)
    return found


def run_in_node(on, folder, out, only):
    """Hashes of all cases of a folder, run in WebAssembly."""
    documents = []
    for path in sorted(folder.glob("*.toml")):
        if only and path.stem not in only:
            continue
        toml = path.read_text()
        beside = [other for other in folder.iterdir() if other.suffix != ".toml" and f'"{other.name}"' in toml]
        files = {other.name: base64.b64encode(other.read_bytes()).decode() for other in beside}
        documents.append({"name": path.stem, "toml": toml, "files": files})
    (out / "cases.json").write_text(json.dumps(documents))
    subprocess.run([on.node, HERE / "wasm.mjs", out / "cases.json", out], check=True)
    found = {}
    for document in documents:
        with zipfile.ZipFile(out / f"{document['name']}.zip") as archive:
            # The command draws the pictures of one case alone, which takes most of the time.
            names = [name for name in archive.namelist() if document["name"] == DRAWN or Path(name).suffix not in PICTURES]
            found[document["name"]] = hashes((name, archive.read(name)) for name in names)
    return found


def found_on(on, is_full, only):
    """Hashes of all that is run on a platform, by kind and name."""
    out = WORK / "out"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    os.chdir(ROOT)
    run = run_in_node if isinstance(on, Wasm) else run_by_command
    found = {}
    for kind in ["cut", "whole"] if is_full else ["cut"]:
        found.update({f"{kind}/{name}": line for name, line in run(on, cases(kind == "cut"), out, only).items()})
    if isinstance(on, Wasm) or only:
        return found
    target = Path(os.path.relpath(out))
    command(on, "study", os.path.relpath(HERE / "study.toml"), "--out", target / "study", "--quiet")
    found["study"] = hashes_of_folder(out / "study")
    if is_full:
        command(on, "family", "--docs", target / "family")
        found["family"] = hashes_of_folder(out / "family")
    return found


def differences(found, references):
    """A sentence for each file that is another than on the machine of the references. Files that a platform does not make are left out."""
    told = []
    for name, line in found.items():
        if name not in references:
            told.append(f"{name}: there is no reference: write one by --pin")
            continue
        here, there = (dict(zip(*[iter(one.split(" "))] * 2, strict=True)) for one in (line, references[name]))
        told += [f"{name}: {file} is another" for file in here if here[file] != there.get(file)]
    return told


def read_references():
    """Lines of the file of references, by kind and name."""
    lines = REFERENCES.read_text().splitlines() if REFERENCES.exists() else []
    return dict(line.split(" ", 1) for line in lines if not line.startswith("#"))


def write_references(found):
    """Writes the file of references."""
    head = "# Kind and name, then files with 16 digits of the SHA-256 of each. Written by tests/platforms/run.py --pin.\n"
    REFERENCES.write_text(head + "".join(f"{name} {found[name]}\n" for name in sorted(found)))


def write_row(on, found, told):
    """Writes what was found on a platform to the table of the page."""
    count = {kind: sum(name.startswith(f"{kind}/") for name in found) for kind in ["cut", "whole"]}
    others = [name for name in ["study", "family"] if name in found]
    cells = [on.title, on.how, str(count["cut"]), str(count["whole"] or "–"), ", ".join(others) or "–"]
    outcome = "the same bytes" if not told else f"{len(told)} files differ"
    row = f"| {' | '.join([*cells, outcome])} |\n"
    before, rest = PAGE.read_text().split(BEGIN)
    table, after = rest.split(END)
    head, line, *rows = table.splitlines(keepends=True)
    rows = [other for other in rows if not other.startswith(f"| {on.title} |")] + [row]
    PAGE.write_text(before + BEGIN + head + line + "".join(rows) + END + after)


def main():
    options = argparse.ArgumentParser(description="Compares what slipfront computes on several platforms.")
    names = ["baseline", "AVX2", "AVX-512", "aarch64", "windows", "wasm"]
    options.add_argument("platform", nargs="*", help="platforms to try (all)")
    options.add_argument("--full", action="store_true", help="cases to their end and the family as well")
    options.add_argument("--pin", action="store_true", help="write the hashes anew")
    options.add_argument("--table", action="store_true", help="write the outcome to docs/reliability.md")
    options.add_argument("--case", action="append", help="these cases alone; may be repeated")
    options.add_argument("--program", type=Path, help="another program than that of release/build.sh")
    chosen = options.parse_args()
    if unknown := set(chosen.platform) - set(names):
        fail(f"there is no platform {', '.join(sorted(unknown))}: they are {', '.join(names)}")
    program = chosen.program and chosen.program.resolve()
    if chosen.pin:
        on = Native("baseline", program)
        on.environment = {}
        write_references(found_on(on, True, None))
        return
    references = read_references()
    bad = 0
    for name in chosen.platform or names:
        start = time.monotonic()
        on = platform(name, program)
        found = found_on(on, chosen.full, chosen.case)
        told = differences(found, references)
        bad += len(told)
        print("\n".join([*told, f"{on.title}, {on.how}: {len(found)} compared, {len(told)} files differ, {time.monotonic() - start:.0f} s"]))
        if chosen.table and not chosen.case:
            write_row(on, found, told)
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
