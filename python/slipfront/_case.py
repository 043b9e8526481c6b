"""Cases: what is to be run."""

from __future__ import annotations

import contextlib
import functools
import html
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _slipfront, _toml
from ._pickle import sealed

Overrides: TypeAlias = Mapping[str, Any]
"""Keys with dots, such as ``drive.v_star`` or ``texture.0.coverage``, and their values; or names of tables with the keys to set there."""


class Case:
    """A case that can be run: valid, resolved, and never changed.

    It is made by `load`, `parse` or `from_dict`, and by `replace` of another case. Values are those of a case file: numbers,
    words, quantities such as ``"50 kPa"`` or of pint, lists and tables. Where a case names the file of a mask or of a field, an
    array with two dimensions (rows from y = 0 on) may stand in its place.

    Raises
    ------
    CaseError
        When the case cannot be run, in the sentence of the command, with `line` and `column`.

    Examples
    --------
    >>> case = Case.from_dict({"slider": {"blocks": [12, 10]}, "time": {"duration_star": 150}})
    >>> case.shape
    (10, 12)
    >>> case.replace({"drive.v_star": 0.05}).numbers["v_star"]
    0.05
    """

    _make: Callable[[], _slipfront.Case]

    def __init__(self, native: _slipfront.Case) -> None:
        object.__setattr__(self, "_native", native)

    @functools.cached_property
    def _native(self) -> _slipfront.Case:
        """The case of a pickle that was loaded where none can be made."""
        return self._make()

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a case never changes: make another one with `case.replace({{...}})` to set {name!r}")

    @classmethod
    def load(cls, path: str | os.PathLike[str], overrides: Overrides | None = None) -> Case:
        """The case of a file.

        Parameters
        ----------
        path
            The case file; what it names stands relative to it.
        overrides
            Keys that are set anew.

        Examples
        --------
        >>> Case.load("cases/circle.toml", {"drive.v_star": 0.05}).name
        'circle'
        """
        arrays = _toml.Arrays()
        return cls(_slipfront.Case.load(Path(path), _overrides(overrides, arrays), arrays.contents))

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
            What stands in a case file.
        overrides
            Keys that are set anew.
        name
            What the case is called in messages and results.
        folder
            Where the files stand that it names: the working directory, unless it is given.

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
        return cls(_slipfront.Case.parse(text, name, Path(folder), _overrides(overrides, arrays), arrays.contents))

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], *, name: str = "case") -> Case:
        """The case of a dictionary with the tables and keys of a case file.

        Parameters
        ----------
        tables
            Tables by their names; keys may have dots.
        name
            What the case is called in messages and results.

        Examples
        --------
        >>> mask = np.zeros((20, 20), dtype=bool)
        >>> mask[8:12, 8:12] = True
        >>> case = Case.from_dict({"slider": {"blocks": [20, 20]}, "texture": [{"shape": "mask", "file": mask}]})
        >>> int(case.textured.sum())
        16
        """
        arrays = _toml.Arrays()
        return cls(_slipfront.Case.parse(_toml.document(tables, arrays), name, Path(), [], arrays.contents))

    def replace(self, overrides: Overrides) -> Case:
        """This case with other values of some keys.

        Examples
        --------
        >>> case = Case.load("cases/circle.toml").replace({"texture.0.coverage": 5, "friction.seed": 7})
        >>> round(case.numbers["texture_percent"])
        5
        """
        arrays = _toml.Arrays(self._native.arrays)
        set_anew = _overrides(overrides, arrays)
        return type(self)(_slipfront.Case.parse(self._text(), self.name, Path(), set_anew, arrays.contents))

    @property
    def name(self) -> str:
        """What the case and its results are called."""
        return self._native.name

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of blocks: N_y and N_x."""
        return self._native.shape

    @property
    def last_step(self) -> int:
        """The step with which a run ends at the latest."""
        return self._native.last_step

    @property
    def numbers(self) -> dict[str, float]:
        """Dimensionless groups (Eq. 11), the time step, the textured area in %, and the units of what is dimensionless, in SI."""
        return dict(self._native.numbers)

    @property
    def warnings(self) -> list[str]:
        """What a reader should know before trusting the results."""
        return self._native.warnings

    @property
    def textured(self) -> npt.NDArray[np.bool_]:
        """Whether a block is texture, (N_y, N_x), the lowest row first. It cannot be written to."""
        return self._native.textured

    @property
    def mu_static(self) -> npt.NDArray[np.float64]:
        """Static friction coefficient of every block, (N_y, N_x). It cannot be written to."""
        return self._native.mu_static

    @property
    def mu_kinetic(self) -> npt.NDArray[np.float64]:
        """Kinetic friction coefficient of every block, (N_y, N_x). It cannot be written to."""
        return self._native.mu_kinetic

    def to_toml(self) -> str:
        """The resolved case with every default, as `case.toml` of its results has it."""
        return self._native.to_toml()

    def _text(self) -> str:
        """The resolved case, which names files where they stand or as they are called in memory, and not the copies beside its results."""
        text = self.to_toml()
        # A file that has changed would make another case than this one in what is not replaced.
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
        """The hashes of the files that it read, by their names in the resolved case."""
        return {name: hash_ for name, _, hash_ in self._native.inputs}

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(_unpickled, self.to_toml(), self.name, self._native.read_inputs())


def _unpickled(text: str, name: str, files: dict[str, bytes]) -> Case:
    arrays = {_toml.IN_MEMORY + copy: contents for copy, contents in files.items()}
    for copy in files:
        text = text.replace(_toml.word(copy), _toml.word(_toml.IN_MEMORY + copy))
    case = Case.__new__(Case)
    vars(case)["_make"] = functools.partial(_slipfront.Case.parse, text, name, Path(), [], arrays)
    # A process that was forked too late is told when it uses the case: it would die of an exception here, in the midst of reading
    # the tasks of multiprocessing.Pool, which would wait for it for ever.
    with contextlib.suppress(_slipfront.ForkError):
        _ = case._native
    return case


def _overrides(given: Overrides | None, arrays: _toml.Arrays) -> list[str]:
    return [f"{key}={_toml.value(value, arrays)}" for key, value in _toml.by_key(given or {}).items()]


CaseError = _slipfront.CaseError
