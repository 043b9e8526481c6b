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

import slipfront._slipfront as _slipfront
from ._finite import check_numbers
from ._temporary import TemporaryFolder

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_.-]")
_IN_QUOTES = json.JSONEncoder(ensure_ascii=False).encode


IN_MEMORY = _slipfront.IN_MEMORY
"""Beginning of the names of files in memory; a number and the key of the array follow."""


class Arrays:
    """Arrays instead of the name of a file: files of numpy in memory.

    Parameters
    ----------
    others
        Other files in memory that may be named.

    Attributes
    ----------
    contents
        All files, by name.
    """

    def __init__(self, others: Mapping[str, bytes] | None = None) -> None:
        self.contents = dict(others or {})
        folders = (f"{IN_MEMORY}{number}/" for number in itertools.count(1))
        self._folder = next(folder for folder in folders if not any(name.startswith(folder) for name in self.contents))

    def add(self, array: np.ndarray[Any, Any], of: str) -> str:
        """Add the array of a key and return the name of its file, which errors replace with the key."""
        if isinstance(array, np.ma.MaskedArray) and np.ma.is_masked(array):
            # Masked values are unknown: NaN, which the case refuses where it needs a number.
            array = np.ma.filled(array.astype(np.float64), np.nan)
        stem = self._folder + _NOT_IN_NAMES.sub("_", of or "array")
        name = f"{stem}.npy"
        numbers = itertools.count(2)
        while name in self.contents:
            name = f"{stem}-{next(numbers)}.npy"
        self.contents[name] = npy(array)
        return name

    def on_disk(self, text: str) -> tuple[str, TemporaryFolder | None]:
        """A text with files on the disk instead of the arrays, and their folder; None if there is no array."""
        if not self.contents:
            return text, None
        folder = TemporaryFolder()
        for name, contents in self.contents.items():
            path = folder.path / name.removeprefix(IN_MEMORY)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(contents)
            text = text.replace(word(name), word(str(path)))
        return text, folder


def npy(array: np.ndarray[Any, Any]) -> bytes:
    """The file that `numpy.save` writes for an array, row by row.

    >>> file = io.BytesIO()
    >>> np.save(file, np.eye(3))
    >>> npy(np.eye(3)) == file.getvalue()
    True
    """
    kind = (array.dtype, array.shape)
    header = _HEADERS.get(kind)
    if header is None:
        file = io.BytesIO()
        described = {"descr": np.lib.format.dtype_to_descr(array.dtype), "fortran_order": False, "shape": array.shape}
        np.lib.format.write_array_header_1_0(file, described)
        header = file.getvalue()
        if len(_HEADERS) == _MOST_HEADERS:
            _HEADERS.clear()
        _HEADERS[kind] = header
    return header + array.tobytes()


# Searches make thousands of cases with arrays of one kind, and numpy takes as long to write a header as it takes to
# set up a small lattice.
_HEADERS: dict[tuple[np.dtype[Any], tuple[int, ...]], bytes] = {}
_MOST_HEADERS = 64


_NAMES_OF_FILES = frozenset(("file", "displacement_x", "displacement_y", "velocity_x", "velocity_y"))


def names_file(key: str) -> bool:
    """Whether the value of a key is the name of a file, which an array may replace."""
    name = key.rpartition(".")[2]
    return name in _NAMES_OF_FILES or name.endswith(("_file", "_field"))


def value(given: Any, arrays: Arrays, of: str = "") -> str:
    """A value in TOML; its key, with dots, says whether it names a file.

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
        pairs = (f"{key(_text(name))} = {value(inner, arrays, _below(of, name))}" for name, inner in given.items())
        return "{ " + ", ".join(pairs) + " }"
    if hasattr(given, "magnitude") and hasattr(given, "units"):
        return _quantities(given)
    if hasattr(given, "__array__"):
        array = np.asanyarray(given)
        # An array with rows is a field or a mask, for which a case names a file; heights may be missing. The last
        # state of a run has layers of rows.
        if array.ndim == 2 or (array.ndim == 3 and names_file(of)):
            return word(arrays.add(array, of))
        check_numbers(of, array)
        return value(array.tolist(), arrays)
    if isinstance(given, Sequence) and not isinstance(given, (bytes, bytearray, memoryview)):
        if names_file(of):
            return word(arrays.add(_rows(of, given), of))
        return "[" + ", ".join(value(inner, arrays, _below(of, str(place))) for place, inner in enumerate(given)) + "]"
    raise _refused(
        f"{f'`{of}`: ' if of else ''}a case is made of tables, lists, words, numbers, quantities and arrays, not of {type(given).__name__}"
    )


def _below(of: str, name: str) -> str:
    return f"{of}.{name}" if of else name


def _rows(of: str, given: Sequence[Any]) -> np.ndarray[Any, Any]:
    """The array of a list of rows."""
    try:
        array = np.asarray(given)
        if array.ndim == 2 and array.dtype.kind in "biuf":
            return array
    except ValueError:
        pass
    raise ValueError(f"`{of}` is the name of a file, an array with two dimensions, or a list of rows of numbers, all of one length")


def by_key(overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Overrides key by key: a table that is given by name sets the keys that it has, and leaves its others as they are.

    >>> by_key({"drive": {"v_star": 0.1}, "friction.seed": 2, "output": {"snapshots": {"every": 1.0}}})
    {'drive.v_star': 0.1, 'friction.seed': 2, 'output.snapshots': {'every': 1.0}}
    """
    found: dict[str, Any] = {}
    for name, given in overrides.items():
        if isinstance(given, Mapping) and "." not in _text(name):
            found |= {f"{name}.{_text(inner)}": value for inner, value in given.items()}
        else:
            found[_text(name)] = given
    return found


def _text(name: object) -> str:
    """A key, which is a text."""
    if not isinstance(name, str):
        raise _refused(f"a key of a case is a text such as 'drive', not {name!r}")
    return name


def _refused(sentence: str) -> _slipfront.CaseError:
    """An error of a case that has no text, so that its value has no line."""
    error = _slipfront.CaseError(sentence)
    error.line = error.column = None
    return error


def word(text: str) -> str:
    """A text in TOML."""
    return _IN_QUOTES(text)


def key(name: str) -> str:
    """A key in TOML."""
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
            headed += [f"[{key(_text(name))}]", *_lines(given, arrays, name)]
        elif isinstance(given, Sequence) and given and all(isinstance(one, Mapping) for one in given):
            _text(name)
            for place, one in enumerate(given):
                headed += [f"[[{key(name)}]]", *_lines(one, arrays, f"{name}.{place}")]
        else:
            plain += _lines({name: given}, arrays, "")
    return "\n".join([*plain, *headed, ""])


def _lines(table: Mapping[str, Any], arrays: Arrays, of: str) -> list[str]:
    return [f"{_path(name)} = {value(given, arrays, _below(of, name))}" for name, given in table.items()]


def _path(name: str) -> str:
    """A key with dots is a key within tables, as in the command's --set."""
    return ".".join(key(part) for part in _text(name).split("."))


def _number(number: float) -> str:
    if math.isnan(number):
        return "nan"
    if math.isinf(number):
        return "inf" if number > 0 else "-inf"
    return repr(number)


def _quantities(given: Any) -> str:
    """A quantity of pint, or a list of them, in its own units."""
    unit = format(given.units, "~C").replace("**", "^").replace("*", " ")
    magnitude = np.asarray(given.magnitude).tolist()

    def write(number: Any) -> str:
        if isinstance(number, list):
            return "[" + ", ".join(write(one) for one in number) + "]"
        # A quantity without a unit is written as a number.
        return word(f"{number!r} {unit}") if unit else value(number, Arrays())

    return write(magnitude)
