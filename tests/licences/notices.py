#!/usr/bin/env python3
"""Writes the licence notices of all that the programs of slipfront contain, which `slipfront licences` shows:

    tests/licences/notices.py           of all programs and platforms, into the package of the command
    tests/licences/notices.py --check   fails where they are not those of the locked versions of all crates
    tests/licences/notices.py --package python --target x86_64-pc-windows-msvc --output FILE

The last writes those of one program on one platform. Needs cargo and Python 3.9 or later.
"""

import argparse
import difflib
import re
import textwrap
from pathlib import Path

from crates import REPOSITORY, alternatives, cargo, fail, packages, run

NOTICES = REPOSITORY / "crates/slipfront-cli/THIRD-PARTY-NOTICES.txt"
# The command, the module for Python and the command for ranks, each by the folder of its crate.
PACKAGES = ["crates/slipfront-cli", "python", "crates/slipfront-mpi"]
TARGETS = [
    "aarch64-apple-darwin",
    "aarch64-unknown-linux-gnu",
    "aarch64-unknown-linux-musl",
    "x86_64-apple-darwin",
    "x86_64-pc-windows-gnu",
    "x86_64-pc-windows-msvc",
    "x86_64-unknown-linux-gnu",
    "x86_64-unknown-linux-musl",
]
# What is no crate, with the file of its licence.
PARTS = {
    "DejaVu Sans, of which the letters in pictures are a part": "crates/slipfront-plot/src/font/LICENSE",
    "friction of basalt, a record beside the cases of the laboratory": "crates/slipfront-lab/cases/calibrations/basalt.LICENSE",
    "friction of paper, a record beside the cases of the laboratory": "crates/slipfront-lab/cases/calibrations/paper.LICENSE",
    "uPlot, which draws the curves of the laboratory": "crates/slipfront-lab/web/vendor/uPlot.LICENSE",
    "the standard library of Rust": "tests/licences/rust-standard-library.txt",
}
MUSL = {"the C library musl, in programs for Linux with musl": "tests/licences/musl.txt"}

HEAD = """\
What slipfront contains, and under which licences

slipfront may be used under the MIT License or the Apache License 2.0, as you choose. It contains the
work of others, listed here with the licences that each declares, and then their texts. Texts that
belong to several are there once. Made by tests/licences/notices.py for all of these programs and
platforms, of which one alone may contain less:
"""
WIDTH = 100


def feature_options(folder, targets):
    """Options of cargo for the features that a release has: the driver of a GPU can be loaded on Windows, and on Linux with glibc.

    slipfront-mpi has no such feature.

    >>> feature_options("python", ["x86_64-unknown-linux-gnu"]), feature_options("python", ["x86_64-unknown-linux-musl"])
    (['--features=gpu'], [])
    """
    can_load = any("windows" in target or "linux-gnu" in target for target in targets)
    return ["--features=gpu"] if can_load and folder != "crates/slipfront-mpi" else []


def linked(folder, targets):
    """Name and version of each crate that is compiled into a program: not what only builds it, tests it, or is a macro."""
    platforms = [f"--target={target}" for target in targets]
    options = ["--edges=normal,no-proc-macro", "--prefix=none", "--format={p}", *feature_options(folder, targets)]
    tree = cargo("tree", f"{folder}/Cargo.toml", *options, *platforms)
    return {(line.split()[0], line.split()[1].removeprefix("v")) for line in tree.splitlines() if line}


def contained(folders, targets):
    """The packages that slipfront's programs in these folders contain, without its own, sorted by name and version."""
    found = {}
    for folder in folders:
        known = {(package["name"], package["version"]): package for package in packages(f"{folder}/Cargo.toml", *feature_options(folder, targets))}
        found.update({crate: known[crate] for crate in linked(folder, targets)})
    others = []
    for (name, version), package in sorted(found.items()):
        if package["source"]:
            others.append(package)
        elif not name.startswith("slipfront"):
            fail(f"{name} {version} comes from a folder: list it in PARTS of tests/licences/notices.py, or take it from crates.io")
    return others


def is_licence(name):
    """Whether a file of this name holds a licence or what must be said beside one.

    >>> [is_licence(name) for name in ["LICENSE-MIT", "license.md", "UNLICENSE", "COPYING", "NOTICE"]]
    [True, True, True, True, True]
    >>> is_licence("Cargo.toml")
    False
    """
    return re.match(r"(un)?licen[cs]e|copying|copyright|notice", name, re.IGNORECASE) is not None


def read(path):
    """The text of a file, the same whatever its tabs and ends of lines are."""
    try:
        text = path.read_text("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path} is no text in UTF-8: {error}") from None
    lines = [line.rstrip() for line in text.expandtabs().strip("\n").splitlines()]
    # They are printed to terminals.
    if unprintable := [line for line in lines if not line.isprintable()]:
        raise ValueError(f"{path}: {unprintable[0]!r} has characters that cannot be printed")
    return "\n".join(lines)


def words(text):
    """Words of a text in small letters: texts with the same words are one licence."""
    return re.findall(r"\w+", text.lower())


def standard(package):
    """The texts of licences for a package that has no file of them: those of slipfront, which are the commonest two."""
    authors = ", ".join(package["authors"]) or f"the authors of {package['name']}"
    mit = re.sub("(?m)^Copyright .*", lambda _: f"Copyright (c) {authors}", read(REPOSITORY / "LICENSE-MIT"))
    known = {"MIT": mit, "Apache-2.0": read(REPOSITORY / "LICENSE-APACHE")}
    # The first choice names the authors in its text.
    for licences in sorted(alternatives(package["license"] or "none"), key=lambda licences: "MIT" not in licences):
        if licences <= set(known):
            return {f"{licence}, standard text": known[licence] for licence in sorted(licences)}
    fail(
        f"{package['name']} {package['version']} has the licence {package['license']} and no file with its text: "
        "add the text to `standard` in tests/licences/notices.py, or do without the crate"
    )


def texts(package, folder):
    """The licence texts of a package in its folder, by the names of their files."""
    files = [file for file in folder.iterdir() if is_licence(file.name)]
    # Some have a folder of them, as in `LICENSES/MIT.txt`.
    files += [inner for file in files if file.is_dir() for inner in file.iterdir()]
    if package["license_file"]:
        files.append(folder / package["license_file"])
    found = {file.relative_to(folder).as_posix(): read(file) for file in sorted(set(files)) if file.is_file()}
    # What is said beside a licence is none, nor are its name alone and the name of another file.
    beside = [name for name, text in found.items() if re.match("copyright|notice", name, re.I) or len(words(text)) < 10]
    return found if len(beside) < len(found) else {**found, **standard(package)}


APACHE_TERMS = re.compile(r"1\. Definitions\..*?END OF TERMS AND CONDITIONS", re.DOTALL)


def without_apache_terms(text):
    """A text in which a reference stands in the place of the terms of the Apache License, which are 9 kB and always the same."""
    terms = words(APACHE_TERMS.search(read(REPOSITORY / "LICENSE-APACHE"))[0])

    def shortened(match):
        return "[Terms 1 to 9 as in LICENSE-APACHE of slipfront, above]" if words(match[0]) == terms else match[0]

    return APACHE_TERMS.sub(shortened, text)


def check_parts():
    """Fails where work of others stands in the crates without a word here."""
    files = [file.relative_to(REPOSITORY) for file in REPOSITORY.glob("crates/*/*/**/*")]
    found = {file.as_posix() for file in files if re.search("LICEN[CS]E", file.name) and "target" not in file.parts}
    if unlisted := found - set(PARTS.values()):
        fail(f"{', '.join(sorted(unlisted))} must be listed in PARTS of tests/licences/notices.py")


def notices(folders, targets):
    """The whole text for the programs in these folders of the repository."""
    parts = {**PARTS, **MUSL} if any("musl" in target for target in targets) else PARTS
    crates = contained(folders, targets)
    lines = [HEAD, *folders, "", *targets, "", *parts, ""]
    lines += [f"{package['name']} {package['version']}: {package['license']}" for package in crates]

    owners = {}

    def add(owner, text):
        owners.setdefault(" ".join(words(text)), (text, []))[1].append(owner)

    for name in ("LICENSE-MIT", "LICENSE-APACHE"):
        add(f"slipfront ({name})", read(REPOSITORY / name))
    for part, path in parts.items():
        add(part, read(REPOSITORY / path))
    for package in crates:
        for file, text in texts(package, Path(package["manifest_path"]).parent).items():
            add(f"{package['name']} {package['version']} ({file})", without_apache_terms(text))
    for text, names in owners.values():
        titles = textwrap.fill("; ".join(names), WIDTH, break_on_hyphens=False, break_long_words=False)
        lines += ["", "=" * WIDTH, titles, "", text]
    return "\n".join(lines) + "\n"


def main():
    options = argparse.ArgumentParser(description="Writes the licence notices of what slipfront contains.")
    options.add_argument("--package", action="append", help="folder of a program's crate; may be repeated (all three)")
    options.add_argument("--target", action="append", help="platform as `rustc --print target-list` names it; may be repeated")
    options.add_argument("--output", type=Path, default=NOTICES, help="file to write (that of the command's package)")
    options.add_argument("--check", action="store_true", help="write nothing, and fail if the file is another")
    chosen = options.parse_args()
    check_parts()
    text = notices(chosen.package or PACKAGES, chosen.target or TARGETS)
    if not chosen.check:
        # In bytes, since Windows would write other ends of lines.
        chosen.output.write_bytes(text.encode())
        return
    shipped = chosen.output.read_bytes().decode() if chosen.output.exists() else ""
    if shipped != text:
        changes = difflib.unified_diff(shipped.splitlines(), text.splitlines(), "shipped", "of the locked crates", n=0, lineterm="")
        fail(
            f"{chosen.output} is not of the crates that are locked: run tests/licences/notices.py, and look at what it changes:\n"
            + "\n".join(list(changes)[:30])
        )


if __name__ == "__main__":
    run(main)
