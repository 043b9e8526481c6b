"""Cases that can be run."""

from __future__ import annotations

import contextlib
import functools
import html
import io
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

import slipfront._slipfront as _slipfront
import slipfront._toml as _toml
from ._pickle import sealed

Overrides: TypeAlias = Mapping[str, Any]
"""Keys with dots, such as ``drive.v_star`` or ``texture.0.coverage``, and their values; or names of tables with the keys to set there."""


class Case:
    """A case that can be run: valid, resolved, and never changed.

    It is made from a dictionary, by `load` from a file, by `parse` from a text, or by `replace` from another case. Values are those
    of a case file: numbers, words, quantities such as ``"50 kPa"`` or of pint, lists and tables. An array with two dimensions or
    a list of rows (from y = 0 on) may replace the file of a mask or of a field.

    Parameters
    ----------
    tables
        Tables by name; keys may have dots.
    overrides
        Keys to change.
    name
        Name of the case in messages and results.

    Raises
    ------
    CaseError
        When the case cannot be run, with the message of the command, `line` and `column`; for a missing file it is also a
        `FileNotFoundError`.

    Examples
    --------
    >>> case = Case({"slider": {"blocks": [12, 10]}, "time": {"duration_star": 150}})
    >>> case.shape
    (10, 12)
    >>> case.replace({"drive.v_star": 0.05})["drive.v_star"]
    0.05
    >>> rows = [[0, 0, 0], [0, 1, 0]]
    >>> int(Case({"slider": {"blocks": [3, 2]}, "texture": [{"shape": "mask", "file": rows}]}).textured.sum())
    1
    """

    _make: Callable[[], _slipfront.Case]

    def __init__(self, tables: Mapping[str, Any], overrides: Overrides | None = None, *, name: str = "case") -> None:
        if not isinstance(tables, Mapping):
            raise TypeError(
                f"a case is made from a dictionary of its tables, not from {type(tables).__name__}: "
                "from a file by Case.load, from a text by Case.parse"
            )
        arrays = _toml.Arrays()
        text, changed = _toml.document(tables, arrays), set_anew(overrides, arrays)
        self._set(_slipfront.Case.parse(text, name, Path(), changed, arrays.contents))

    @classmethod
    def _of(cls, native: _slipfront.Case) -> Case:
        case = cls.__new__(cls)
        case._set(native)
        return case

    def _set(self, native: _slipfront.Case) -> None:
        object.__setattr__(self, "_native", native)

    @functools.cached_property
    def _native(self) -> _slipfront.Case:
        """The case of a pickle that was loaded in a process that cannot make one."""
        return self._make()

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a case never changes: make another one with `case.replace({{...}})` to set {name!r}")

    @classmethod
    def load(cls, path: str | os.PathLike[str], overrides: Overrides | None = None) -> Case:
        """The case of a file.

        Parameters
        ----------
        path
            The case file; paths in it are relative to its folder.
        overrides
            Keys to change.

        Examples
        --------
        >>> Case.load("cases/circle.toml", {"drive.v_star": 0.05}).name
        'circle'
        """
        arrays = _toml.Arrays()
        return cls._of(_slipfront.Case.load(Path(path), set_anew(overrides, arrays), arrays.contents))

    @classmethod
    def parse(
        cls,
        text: str,
        overrides: Overrides | None = None,
        *,
        name: str = "case",
        folder: str | os.PathLike[str] = "",
    ) -> Case:
        """The case of a text.

        Parameters
        ----------
        text
            The content of a case file.
        overrides
            Keys to change.
        name
            Name of the case in messages and results.
        folder
            Folder of the files that it names, by default the working directory.

        Examples
        --------
        >>> Case.parse("slider.blocks = [4, 4]").shape
        (4, 4)
        >>> try:
        ...     Case.parse("slider.blocks = [4, 4]\\ndrive.v_start = 0.1")
        ... except CaseError as error:
        ...     print(error.line, error.column)
        2 7
        """
        arrays = _toml.Arrays()
        return cls._of(_slipfront.Case.parse(text, name, Path(folder), set_anew(overrides, arrays), arrays.contents))

    def replace(self, overrides: Overrides) -> Case:
        """Return the case with other values of some keys.

        Examples
        --------
        >>> case = Case.load("cases/circle.toml").replace({"texture.0.coverage": 5, "friction.seed": 7})
        >>> round(case.numbers["texture_percent"])
        5
        """
        arrays = _toml.Arrays(self._native.arrays)
        changed = set_anew(overrides, arrays)
        return self._of(_slipfront.Case.parse(self._text(), self.name, Path(), changed, arrays.contents))

    @property
    def name(self) -> str:
        """Name of the case and of its results."""
        return self._native.name

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of blocks: N_y and N_x."""
        return self._native.shape

    @property
    def last_step(self) -> int:
        """The last step of a run, unless it ends earlier."""
        return self._native.last_step

    @property
    def numbers(self) -> dict[str, float]:
        """Dimensionless groups (Eq. 11), the time step, the textured area in %, and the units of dimensionless quantities, in SI."""
        return dict(self._native.numbers)

    @property
    def warnings(self) -> list[str]:
        """Warnings that a reader should know before trusting the results."""
        return self._native.warnings

    @property
    def textured(self) -> npt.NDArray[np.bool_]:
        """Whether each block is textured, (N_y, N_x), the lowest row first. The array is read-only."""
        return self._native.textured

    @property
    def mu_static(self) -> npt.NDArray[np.float64]:
        """Static friction coefficient of every block, (N_y, N_x). The array is read-only."""
        return self._native.mu_static

    @property
    def mu_kinetic(self) -> npt.NDArray[np.float64]:
        """Kinetic friction coefficient of every block, (N_y, N_x). The array is read-only."""
        return self._native.mu_kinetic

    def to_toml(self) -> str:
        """The resolved case with every default, the text of `case.toml` in its results."""
        return self._native.to_toml()

    def to_dict(self) -> dict[str, Any]:
        """The resolved case as a dictionary for `Case`, with every default, paths of files, and arrays.

        Examples
        --------
        >>> case = Case({"drive": {"v_star": 0.05}})
        >>> case.to_dict()["drive"]["v_star"]
        0.05
        >>> Case(case.to_dict()) == case
        True
        """
        arrays = {name: np.load(io.BytesIO(contents)) for name, contents in self._native.arrays.items()}
        files = {copy: arrays.get(str(original), str(original.absolute())) for copy, original, _ in self._native.inputs}
        return dict(_with_files(json.loads(self._native.to_json()), files))

    def __getitem__(self, key: str) -> Any:
        """The value of a key with dots, such as ``drive.v_star`` or ``texture.0.coverage``, or a table; its default if it was not given.

        Raises
        ------
        KeyError
            When the resolved case has no such key.
        """
        if not isinstance(key, str):
            raise TypeError(f"a key of a case is a text such as 'drive.v_star', not {key!r}")
        found: Any = self.to_dict()
        parts = key.split(".")
        for place, part in enumerate(parts):
            below = dict(enumerate(found)) if isinstance(found, list) else found
            name = int(part) if isinstance(found, list) and part.isdecimal() else part
            if not isinstance(below, dict) or name not in below:
                within = f"`{'.'.join(parts[:place])}` of the case" if place else "the case"
                known = ", ".join(map(str, below)) if isinstance(below, dict) else "no keys"
                raise KeyError(f"{within} has no `{part}`: it has {known or 'none'}")
            found = below[name]
        return found

    def _text(self) -> str:
        """The resolved case with the paths of files or their names in memory, instead of the copies with its results."""
        text = self.to_toml()
        # A changed file would change keys that are not replaced.
        self._native.read_inputs()
        arrays = self._native.arrays
        for copy, original, _ in self._native.inputs:
            name = str(original) if str(original) in arrays else str(original.absolute())
            text = text.replace(_toml.word(copy), _toml.word(name))
        return text

    def __repr__(self) -> str:
        return self._native.physics.rstrip()

    def _repr_html_(self) -> str:
        from ._html import numbers, picture

        rows = [(line[3:12].strip(), line[13:]) for line in self._native.physics.splitlines()[1:]]
        return f"<b>{html.escape(self.name)}</b>{picture(self.textured)}{numbers(rows)}"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Case):
            return NotImplemented
        return self.to_toml() == other.to_toml() and self._hashes() == other._hashes()

    def __hash__(self) -> int:
        return hash(self.to_toml())

    def _hashes(self) -> dict[str, str]:
        """The hashes of the files that the case has read, by their names in the resolved case."""
        return {name: hash_ for name, _, hash_ in self._native.inputs}

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(_unpickled, self.to_toml(), self.name, self._native.read_inputs())


def _unpickled(text: str, name: str, files: dict[str, bytes]) -> Case:
    arrays = {_toml.IN_MEMORY + copy: contents for copy, contents in files.items()}
    for copy in files:
        text = text.replace(_toml.word(copy), _toml.word(_toml.IN_MEMORY + copy))
    case = Case.__new__(Case)
    vars(case)["_make"] = functools.partial(_slipfront.Case.parse, text, name, Path(), [], arrays)
    # A process that was forked too late gets the error when it uses the case. An exception here would end it while it
    # reads the tasks of multiprocessing.Pool, which would wait for it for ever.
    with contextlib.suppress(_slipfront.ForkError):
        _ = case._native
    return case


def _with_files(value: Any, files: Mapping[str, Any]) -> Any:
    """A value of a resolved case with files instead of their names there, and without keys that have no value."""
    if isinstance(value, list):
        return [_with_files(inner, files) for inner in value]
    if not isinstance(value, dict):
        return value
    given = {key: inner for key, inner in value.items() if inner is not None}
    return {key: files.get(inner, inner) if _toml.names_file(key) else _with_files(inner, files) for key, inner in given.items()}


def as_case(given: CaseLike, overrides: Overrides | None = None) -> Case:
    """A case, made from its tables or its file if necessary, with other values of some keys."""
    if isinstance(given, Case):
        return given if overrides is None else given.replace(overrides)
    return Case(given, overrides) if isinstance(given, Mapping) else Case.load(given, overrides)


CaseLike: TypeAlias = Case | Mapping[str, Any] | str | os.PathLike[str]
"""A case, its tables as `Case` takes them, or the path of a case file."""


def set_anew(overrides: Overrides | None, arrays: _toml.Arrays) -> list[str]:
    """Overrides as the command takes them, KEY=VALUE."""
    if overrides is None:
        return []
    if not isinstance(overrides, Mapping):
        raise TypeError(
            f"keys to change are a dictionary such as {{'drive.v_star': 0.05}}, not {overrides!r}: give other arguments by name"
        )
    return [f"{key}={_toml.value(value, arrays, key)}" for key, value in _toml.by_key(overrides).items()]


CaseError = _slipfront.CaseError


class MissingFileError(CaseError, FileNotFoundError):
    """Error: the file of a case or a study is missing; the native part raises it."""
