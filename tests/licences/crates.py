"""Crates of a workspace as cargo lists them, and the meaning of their licence expressions."""

import json
import re
import subprocess
import sys
from itertools import product
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def fail(sentence):
    """Ends the program with a sentence that tells place, value and remedy."""
    sys.exit(f"error: {sentence}")


def run(main):
    """Runs a program whose errors of files and texts are sentences."""
    try:
        main()
    except (OSError, ValueError) as error:
        fail(error)


def cargo(command, manifest, *arguments):
    """The output of cargo for the locked versions of the workspace that `manifest` belongs to."""
    line = ["cargo", command, "--quiet", "--locked", "--manifest-path", str(REPOSITORY / manifest), *arguments]
    ran = subprocess.run(line, stdout=subprocess.PIPE, text=True)
    if ran.returncode:
        fail(f"`{' '.join(line)}` fails with what it says above")
    return ran.stdout


def packages(manifest, *arguments):
    """All packages of a workspace as `cargo metadata` tells them, those of other platforms too."""
    return json.loads(cargo("metadata", manifest, "--format-version=1", *arguments))["packages"]


def alternatives(expression):
    """The sets of licences of an SPDX expression, each of which is enough to use the crate.

    >>> [sorted(licences) for licences in alternatives("(MIT OR Apache-2.0) AND Unicode-3.0")]
    [['MIT', 'Unicode-3.0'], ['Apache-2.0', 'Unicode-3.0']]
    >>> alternatives("Apache-2.0 WITH LLVM-exception")
    [frozenset({'Apache-2.0 WITH LLVM-exception'})]

    Crates of before 2018 may have a slash in place of OR.

    >>> len(alternatives("Unlicense/MIT"))
    2
    """
    tokens = re.findall(r"[()]|[^\s()]+", expression.replace("/", " OR "))
    operators = {"(", ")", "AND", "OR", "WITH"}

    def take(*wanted):
        if tokens and tokens[0] in wanted:
            return tokens.pop(0)
        return None

    def name():
        if not tokens or tokens[0] in operators:
            raise ValueError(f"`{expression}` is no SPDX expression: a licence is missing")
        return tokens.pop(0)

    def one():
        if take("("):
            inner = either()
            if not take(")"):
                raise ValueError(f"`{expression}` is no SPDX expression: a parenthesis is not closed")
            return inner
        licence = name()
        return [frozenset([f"{licence} WITH {name()}" if take("WITH") else licence])]

    def both():
        sets = one()
        while take("AND"):
            sets = [left | right for left, right in product(sets, one())]
        return sets

    def either():
        sets = both()
        while take("OR"):
            sets += both()
        return sets

    sets = either()
    if tokens:
        raise ValueError(f"`{expression}` is no SPDX expression: `{tokens[0]}` stands where AND or OR belongs")
    return sets
