#!/usr/bin/env python3
"""Counts words by which a text reads as a translation, in the pages that people write.

    tests/plain_words.py

Code, keys, links and quotations are left out, and so are pages that a program writes. Exits with 1 if there are
more of them than `MOST`, and then lists the lines.
"""

import re
import subprocess
import sys
from pathlib import Path

WORDS = ["told", "tells", "alike", "such that", "whose", "beside", "likewise", "stands in", "wished", "anyhow"]

# Fewer than a third of what there was before the pages were rewritten, 188; most are needed (`whose`).
MOST = 55

# Pages that a program writes, and the list of changes.
WRITTEN = ["docs/reference/", "docs/validation/", "CHANGELOG.md", "THIRD-PARTY"]

FIND = re.compile(r"\b(" + "|".join(WORDS) + r")\b", re.IGNORECASE)


def lines(path):
    """Yield the numbers and the prose of the lines of a page."""
    is_code = False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith("```"):
            is_code = not is_code
        elif not is_code and not line.startswith("#"):
            yield number, re.sub(r"`[^`]*`|\]\([^)]*\)|\"[^\"]*\"", "", line)


def main():
    """Count, and list where there are too many."""
    files = subprocess.run(["git", "ls-files", "*.md"], check=True, capture_output=True, text=True).stdout.split()
    pages = [Path(file) for file in files if not any(part in file for part in WRITTEN)]
    found = [
        f"{page}:{number}: {line.strip()}" for page in pages for number, line in lines(page) for _ in FIND.findall(line)
    ]
    print(f"{len(found)} words of a translation, at most {MOST}")
    if len(found) > MOST:
        sys.exit("\n".join(found))


main()
