"""Values of Python as the text of a case: TOML, quantities with their units, arrays as files in memory."""

from __future__ import annotations

import io
import itertools
import json
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ._temporary import TemporaryFolder

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


IN_MEMORY = "memory:/"
"""How the names of files begin that are in memory."""


class Arrays:
    """Arrays that are handed over in place of the name of a file: files of numpy in memory.

    Parameters
    ----------
    others
        Files in memory that may be named beside them.

    Attributes
    ----------
    contents
        All of them, by their names.
    """

    def __init__(self, others: Mapping[str, bytes] | None = None) -> None:
        self.contents = dict(others or {})
        folders = (f"{IN_MEMORY}{number}/" for number in itertools.count(1))
        self._folder = next(folder for folder in folders if not any(name.startswith(folder) for name in self.contents))
        self._count = 0

    def add(self, array: np.ndarray[Any, Any]) -> str:
        """Add an array and give the name of its file."""
        if np.ma.is_masked(array):
            # What is masked is not known: NaN, which the case refuses where it cannot do without.
            array = np.ma.filled(array.astype(np.float64), np.nan)
        self._count += 1
        name = f"{self._folder}array-{self._count}.npy"
        file = io.BytesIO()
        np.save(file, np.ascontiguousarray(array))
        self.contents[name] = file.getvalue()
        return name

    def on_disk(self, text: str) -> tuple[str, TemporaryFolder | None]:
        """A text that names files on the disk in their place, and the folder that holds these; none if there is no array."""
        if not self.contents:
            return text, None
        folder = TemporaryFolder()
        for name, contents in self.contents.items():
            path = folder.path / name.removeprefix(IN_MEMORY)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(contents)
            text = text.replace(word(name), word(str(path)))
        return text, folder


def value(given: Any, arrays: Arrays) -> str:
    """A value as TOML writes it.

    >>> arrays = Arrays()
    >>> value({"shape": "cavity", "coverage": 10, "center": (1, 2.5)}, arrays)
    '{ shape = "cavity", coverage = 10, center = [1, 2.5] }'
    """
    if isinstance(given, (bool, np.bool_)):
        return "true" if given else "false"
    if isinstance(given, (int, np.integer)):
        return str(int(given))
    if isinstance(given, (float, np.floating)):
        return _number(float(given))
    if isinstance(given, str):
        return word(given)
    if isinstance(given, Path):
        return word(str(given))
    if isinstance(given, Mapping):
        pairs = (f"{key(name)} = {value(inner, arrays)}" for name, inner in given.items())
        return "{ " + ", ".join(pairs) + " }"
    if hasattr(given, "magnitude") and hasattr(given, "units"):
        return _quantities(given)
    if hasattr(given, "__array__"):
        array = np.asanyarray(given)
        # What has rows is a field or a mask, of which a case names the file.
        return word(arrays.add(array)) if array.ndim == 2 else value(array.tolist(), arrays)
    if isinstance(given, Sequence):
        return "[" + ", ".join(value(inner, arrays) for inner in given) + "]"
    raise TypeError(
        f"a case is made of tables, lists, words, numbers, quantities and arrays, not of {type(given).__name__}"
    )


def by_key(overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Overrides key by key: those of a table that is given by its name are the keys that it has, and leave its others as they are.

    >>> by_key({"drive": {"v_star": 0.1}, "friction.seed": 2, "output": {"snapshots": {"every": 1.0}}})
    {'drive.v_star': 0.1, 'friction.seed': 2, 'output.snapshots': {'every': 1.0}}
    """
    found: dict[str, Any] = {}
    for name, given in overrides.items():
        if isinstance(given, Mapping) and "." not in name:
            found |= {f"{name}.{inner}": value for inner, value in given.items()}
        else:
            found[name] = given
    return found


def word(text: str) -> str:
    """A text as TOML writes it."""
    return json.dumps(text, ensure_ascii=False)


def key(name: str) -> str:
    """A key as TOML writes it."""
    return name if _BARE_KEY.fullmatch(name) else word(name)


def document(tables: Mapping[str, Any], arrays: Arrays) -> str:
    """The text of a case: a line for each value, a heading for each table.

    >>> print(document({"drive": {"v_star": 0.1}, "texture": [{"shape": "cavity"}]}, Arrays()))
    [drive]
    v_star = 0.1
    [[texture]]
    shape = "cavity"
    <BLANKLINE>
    """
    plain, headed = [], []
    for name, given in tables.items():
        if isinstance(given, Mapping):
            headed += [f"[{key(name)}]", *_lines(given, arrays)]
        elif isinstance(given, Sequence) and given and all(isinstance(one, Mapping) for one in given):
            for one in given:
                headed += [f"[[{key(name)}]]", *_lines(one, arrays)]
        else:
            plain += _lines({name: given}, arrays)
    return "\n".join([*plain, *headed, ""])


def _lines(table: Mapping[str, Any], arrays: Arrays) -> list[str]:
    # A key with dots is a key within tables, as in the command's --set.
    def path(name: str) -> str:
        return ".".join(key(part) for part in name.split("."))

    return [f"{path(name)} = {value(given, arrays)}" for name, given in table.items()]


def _number(number: float) -> str:
    if math.isnan(number):
        return "nan"
    if math.isinf(number):
        return "inf" if number > 0 else "-inf"
    return repr(number)


def _quantities(given: Any) -> str:
    """A quantity of pint, or a list of them, in the units it has."""
    unit = format(given.units, "~C").replace("**", "^").replace("*", " ")
    magnitude = np.asarray(given.magnitude).tolist()

    def write(number: Any) -> str:
        if isinstance(number, list):
            return "[" + ", ".join(write(one) for one in number) + "]"
        # A number without a unit is written as one.
        return word(f"{number!r} {unit}") if unit else value(number, Arrays())

    return write(magnitude)
