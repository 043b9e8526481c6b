#!/usr/bin/env python3
"""Holds what an installed wheel computes to the hashes in tests/platforms/references.txt, with the Python that it is called by:

    python tests/platforms/wheel.py CASE...

CASE is the name of a file under cases/, such as circle; each is cut to 500 steps. Exit status: 1 if a hash differs.
"""

import platform
import sys
import tempfile
from pathlib import Path

import run
import slipfront as sf


def main():
    references = run.read_references()
    cases = run.cases(True)
    names = sys.argv[1:] or [run.DRAWN]
    told = []
    with tempfile.TemporaryDirectory() as out:
        for name in names:
            folder = sf.run(cases / f"{name}.toml").save(Path(out) / name)
            # The references have the pictures of one case.
            for picture in [] if name == run.DRAWN else [*folder.glob("*.png"), *folder.glob("*.svg")]:
                picture.unlink()
            told += run.differences({f"cut/{name}": run.hashes_of_folder(folder)}, references)
    print("\n".join([*told, f"Python {platform.python_version()}, {platform.machine()}: {len(names)} cases, {len(told)} files differ"]))
    sys.exit(1 if told else 0)


if __name__ == "__main__":
    main()
