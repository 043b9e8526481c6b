#!/usr/bin/env python3
"""Has citations of runs with any names read by pybtex and PyYAML: citations.py SLIPFRONT RUN. Needs pybtex of PyPI, which brings PyYAML.

Exit status: 0 all give the names back, 1 one does not.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

import pybtex.database
import yaml

# Every sign of ASCII but the slash, signs of YAML and TeX in a row, and letters, spaces and ends of lines of
# Unicode.
ASCII = "".join(chr(code) for code in range(1, 128) if chr(code) != "/")
NAMES = [ASCII, "{", "a}b", "\\", "\\{", '"', "'", "%", "- a: [b, #c", "@misc{a,", "\u00e4\u00df \u03bc\u6f22\U0001f600", "\x85\u2028\u2029\ufeff\uffff."]

# What TeX prints for the commands of `tex` in citation.rs.
COMMANDS = {
    r"\textbraceleft{}": "{",
    r"\textbraceright{}": "}",
    r"\textasciitilde{}": "~",
    r"\textasciicircum{}": "^",
    r"\&": "&",
    r"\%": "%",
    r"\$": "$",
    r"\#": "#",
    r"\_": "_",
    r"\textbackslash{}": "\\",
}


def printed(value):
    """A value of BibTeX as TeX prints it."""
    text, at = "", 0
    value = value.removeprefix("{").removesuffix("}")
    while at < len(value):
        command = next((command for command in COMMANDS if value.startswith(command, at)), value[at])
        text += COMMANDS.get(command, command)
        at += len(command)
    return text


def spaced(text):
    """A text with one space where there are control characters or spaces, as BibTeX reads it."""
    return " ".join("".join(" " if ord(sign) < 32 or 127 <= ord(sign) < 160 else sign for sign in text).split())


def main(slipfront, run):
    wrong = 0
    with tempfile.TemporaryDirectory() as work:
        for name in NAMES:
            folder = pathlib.Path(work) / name
            shutil.copytree(run, folder)
            # What stands in angle brackets is an ORCID.
            author = spaced(name).replace("<", "")

            def cited(form):
                command = [slipfront, "export", folder, form, f"--author={author}"]
                return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout

            title = f"Friction computed with slipfront: {name}"
            entries = pybtex.database.parse_string(cited("--bibtex"), "bibtex").entries
            entry = next(entry for key, entry in entries.items() if key.startswith("slipfront-run-"))
            persons = [str(person) for person in entry.persons["author"]]
            cff = yaml.safe_load(cited("--cff"))
            for what, found, meant in [
                ("entries", len(entries), 3),
                ("title of BibTeX", spaced(printed(entry.fields["title"])), spaced(title)),
                ("author of BibTeX", [spaced(printed(person)) for person in persons], [author]),
                ("title of CFF", cff["title"], title),
                ("author of CFF", cff["authors"], [{"name": author}]),
            ]:
                if found != meant:
                    print(f"{name!r}: {what} is {found!r} and not {meant!r}")
                    wrong += 1
            shutil.rmtree(folder)
    print(f"{len(NAMES)} names cited, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
