#!/usr/bin/env python3
"""Counts words by which a text reads as a translation, in the pages that people write and in comments of Rust.

    tests/plain_words.py

Code, keys, links and quotations are left out, and so are pages that a program writes. Exits with 1 if pages or
comments have more of them than `MOST`, and then lists the lines.
"""

import re
import subprocess
import sys
from pathlib import Path

WORDS = ["told", "tells", "alike", "such that", "whose", "beside", "likewise", "stands in", "wished", "anyhow"]

# Before they were rewritten, pages had 188 and comments 831; most of those that are left are needed (`whose`).
MOST = {"*.md": 50, "*.rs": 60}

# Pages that a program writes, and the list of changes.
WRITTEN = ["docs/reference/", "docs/validation/", "CHANGELOG.md", "THIRD-PARTY"]

FIND = re.compile(r"\b(" + "|".join(WORDS) + r")\b", re.IGNORECASE)


def prose(path):
    """Yield the numbers and the prose of the lines of a page, or of the comments of a file of Rust."""
    is_code = False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if path.suffix == ".rs":
            line = re.sub(r"^\s*//[/!]? ?", "", line) if line.lstrip().startswith("//") else ""
        if line.lstrip().startswith("```"):
            is_code = not is_code
        elif not is_code and not line.startswith("#"):
            yield number, re.sub(r"`[^`]*`|\]\([^)]*\)|\"[^\"]*\"", "", line)


def main():
    """Count, and list where there are too many."""
    too_many = []
    for kind, most in MOST.items():
        listed = subprocess.run(["git", "ls-files", kind], check=True, capture_output=True, text=True)
        files = [Path(file) for file in listed.stdout.split() if not any(part in file for part in WRITTEN)]
        found = [
            f"{file}:{number}: {line.strip()}"
            for file in files
            for number, line in prose(file)
            for _ in FIND.findall(line)
        ]
        print(f"{kind}: {len(found)} words of a translation, at most {most}")
        too_many += found if len(found) > most else []
    if too_many:
        sys.exit("\n".join(too_many))


main()
