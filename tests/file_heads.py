#!/usr/bin/env python3
"""Prints what each file of the crates is for: its path, and the first sentence of the `//!` comment at its head.

    tests/file_heads.py
    tests/file_heads.py crates/slipfront/src

Takes folders or files, by default the sources of all crates and of the Python module. Fails and names the files
that do not begin with such a comment.
"""

import re
import subprocess
import sys
from pathlib import Path

# A full stop that ends a sentence; one after "Eq" or "Fig" does not.
END = re.compile(r"(?<!\bEq)(?<!\bEqs)(?<!\bFig)\.(?= |$)")


def first_sentence(path):
    """The first sentence of the comment with which a file begins; empty if it begins with something else."""
    head = re.match(r"(?://! .*\n)*", path.read_text(encoding="utf-8")).group()
    text = " ".join(line[4:].strip() for line in head.splitlines())
    end = END.search(text)
    return text[: end.end()] if end else text


def main():
    """Print the table, and fail if a file has no head."""
    folders = sys.argv[1:] or ["crates/*/src/*.rs", "python/src/*.rs"]
    listed = subprocess.run(["git", "ls-files", *folders], capture_output=True, text=True, check=True)
    heads = {name: first_sentence(Path(name)) for name in listed.stdout.split() if name.endswith(".rs")}
    width = max(map(len, heads), default=0)
    print("\n".join(f"{name:<{width}}  {head}" for name, head in heads.items() if head))
    without = [f"{name}: has no `//!` comment at its head" for name, head in heads.items() if not head]
    sys.exit("\n".join(without) or 0)


main()
