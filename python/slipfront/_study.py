"""Studies: a case varied along axes and repeated on several random surfaces."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

import slipfront._slipfront as _slipfront
import slipfront._toml as _toml
from ._axes import Axis, grid, means_by_point
from ._case import Case, CaseLike, Overrides
from ._finite import check_numbers
from ._html import table
from ._keys import StudyKeys
from ._pickle import sealed
from ._progress import shown_runs
from ._project import of_case, of_file
from ._run import Run
from ._simulation import _threads, run
from ._tables import frame, read_table
from ._temporary import TemporaryFolder

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes
    from typing_extensions import Unpack

Quantities: TypeAlias = Mapping[str, Callable[[Run], float]]
"""Names of the user's own quantities, and the functions of a run that compute them."""

Progress: TypeAlias = bool | Callable[[int, int, int], object] | None
"""True for a bar, False for none, None for one in terminals and notebooks, or a function of the numbers of finished runs, of all, and of
failed ones."""

Look: TypeAlias = Callable[[_slipfront.Case, _slipfront.RunData, tuple[int, int, bool]], list[float]]
"""A function that returns the values of own quantities of a run, from its case, its record, and its point, replicate and whether it is the reference."""

Results = TypeVar("Results", bound="StudyResults")


class Study:
    """A study: axes over keys of a case, replicates over seeds.

    Parameters
    ----------
    case
        The case that is varied, a dictionary of its tables or the path of its file; or the path of a study file, with `overrides`
        alone.
    overrides
        Keys of the case to change.
    axes
        Keys with lists of their values, as in `Case`; all combinations are run, the last axis fastest. A name that is not a key has a
        dictionary: the names of variants, and the keys that each of them sets.
    replicates
        Random surfaces per point, by default 1.
    keys
        Other keys of the table ``[study]`` of a study file: ``reference``, ``keep`` and ``until``.

    Examples
    --------
    >>> slider = {"slider": {"blocks": [8, 8]}, "time": {"duration_star": 150}}
    >>> study = Study(slider, axes={"drive.v_star": [0.02, 0.05]}, replicates=2)
    >>> study.n_points
    2
    >>> results = study.run(progress=False)
    >>> len(results.runs)
    4
    """

    def __init__(
        self,
        case: CaseLike,
        overrides: Overrides | None = None,
        *,
        axes: Mapping[str, Sequence[Any] | Mapping[str, Mapping[str, Any]]] | None = None,
        replicates: int | None = None,
        name: str | None = None,
        **keys: Unpack[StudyKeys],
    ) -> None:
        if isinstance(case, (str, os.PathLike)) and axes is None and replicates is None and name is None and not keys:
            self._native, self._arrays = of_file(_slipfront.Study, case, overrides)
            return

        def listed(arrays: _toml.Arrays) -> str:
            return "".join(_axis(name, levels, arrays) for name, levels in (axes or {}).items())

        tables = {"study": {"replicates": 1 if replicates is None else replicates, **keys}}
        self._native, self._arrays = of_case(_slipfront.Study, case, overrides, tables, name, "study", listed)

    @property
    def name(self) -> str:
        """Name of the study."""
        return self._native.name

    @property
    def n_points(self) -> int:
        """Number of combinations of levels."""
        return self._native.n_points

    @property
    def axes(self) -> dict[str, int]:
        """The keys of the axes and the number of their levels."""
        return {", ".join(axis["columns"]): len(axis["levels"]) for axis in self._native.axes}

    @property
    def warnings(self) -> list[str]:
        """Warnings about the cases of the points that a reader should know before trusting the results, the first of each kind."""
        return [
            f"{sentence} (at {'the point' if points == 1 else f'{points} points, the first'} {first})"
            for sentence, points, first in self._native.warnings
        ]

    def case(self, point: int, replicate: int = 0, *, reference: bool = False) -> Case:
        """The case of one run.

        Parameters
        ----------
        point
            The combination of levels, from 0, the last axis fastest.
        replicate
            The random surface, from 0.
        reference
            Whether it is the reference for the reduction of the point.
        """
        if not 0 <= point < self.n_points:
            raise IndexError(f"the study has {self.n_points} points, counted from 0, and none of number {point}")
        if replicate < 0:
            raise IndexError(f"replicates are counted from 0, not {replicate}")
        return Case._of(self._native.case(point, replicate, reference))

    def run(
        self,
        folder: str | os.PathLike[str] | None = None,
        *,
        force: bool = False,
        progress: Progress = None,
        threads: int | None = None,
        quantities: Quantities | None = None,
    ) -> StudyResults:
        """Make the runs that the folder lacks.

        Parameters
        ----------
        folder
            A folder of results, in which a stopped study continues. By default only tables are kept, in memory.
        force
            Replace files of the results that were edited since they were written.
        progress
            True for a bar, False for none, None for one in terminals and notebooks, or a function of the numbers of finished
            runs, of all, and of failed ones.
        threads
            Runs in parallel, by default one per core.
        quantities
            Your own quantities: functions of a run. Their values are columns of `StudyResults.runs`, and their statistics are rows
            of `points`. They are called in the threads of the runs.

        Warns
        -----
        UserWarning
            When no run has a value of the main quantity, such as a transition from static to kinetic friction.

        Examples
        --------
        >>> slider = {"slider": {"blocks": [8, 8]}, "time": {"duration_star": 150}}
        >>> drop = {"drop": lambda run: run.static_friction_star - run.series["mu_star"].values[-1]}
        >>> table = Study(slider, axes={"drive.v_star": [0.02, 0.05]}).run(progress=False, quantities=drop).runs
        >>> bool(table["drop"].min() > 0)
        True
        """
        own = dict(quantities or {})
        for quantity in own:
            if self._native.has_column(quantity):
                raise ValueError(f"the tables have a column `{quantity}` already: give the quantity another name")

        def look(native: _slipfront.Case, record: _slipfront.RunData, _: tuple[int, int, bool]) -> list[float]:
            result = Run(Case._of(native), record)
            return [float(quantity(result)) for quantity in own.values()]

        results, values, why = executed(self._native, StudyResults, folder, force, progress, threads, look if own else None)
        # Own quantities are a result, even without the main one.
        if why is not None and not own:
            warnings.warn(why, stacklevel=2)
        if own:
            self._add(results, own, values)
        return results

    def _add(self, results: StudyResults, own: dict[str, Callable[[Run], float]], values: dict[Any, list[float]]) -> None:
        """Add own quantities to the runs; runs of earlier calls are repeated for them."""
        rows = results._runs
        for point, replicate, role, status in zip(rows["point"], rows["replicate"], rows["role"], rows["status"], strict=True):
            place = (int(point), int(replicate), role == "reference")
            if status == "done" and place not in values:
                again = run(self.case(place[0], place[1], reference=place[2]), progress=False)
                values[place] = [float(quantity(again)) for quantity in own.values()]
            for name, value in zip(own, values.get(place, [np.nan] * len(own)), strict=True):
                rows.setdefault(name, []).append(value)
        points = results._tables["points"]
        axes = [column for axis in self._native.axes for column in axis["columns"]]
        for point in dict.fromkeys(rows["point"]):
            of_point = [k for k, (p, r) in enumerate(zip(rows["point"], rows["role"], strict=True)) if (p, r) == (point, "point")]
            for name in own:
                found = dict(self._native.statistics([rows[name][k] for k in of_point if not np.isnan(rows[name][k])]))
                # Next to an axis of coverages is the meshed coverage.
                beside = [*axes, "texture_percent"]
                row = {"point": point, "quantity": name, **{column: rows[column][of_point[0]] for column in beside}, **found}
                for column, cells in points.items():
                    cells.append(row.get(column, np.nan))

    def __repr__(self) -> str:
        axes = ", ".join(f"{key} ({levels})" for key, levels in self.axes.items())
        return f"Study({self.name}: {self.n_points} points over {axes or 'no axis'})"


class StudyResults:
    """The tables of a study.

    Attributes
    ----------
    folder
        Its path; None for a study in memory.
    """

    def __init__(
        self,
        folder: Path | None,
        tables: dict[str, dict[str, list[Any]]],
        axes: list[Axis],
        failures: Sequence[tuple[str, str]] = (),
    ) -> None:
        self.folder = folder
        self._axes, self._failures = axes, failures
        self._runs = tables["runs"]
        self._tables = tables

    @classmethod
    def read(cls: type[Results], folder: Path, axes: list[Axis], failures: Sequence[tuple[str, str]] = ()) -> Results:
        """The tables in a folder of a study over these axes."""
        return cls(folder, read_tables(folder), axes, failures)

    @property
    def runs(self) -> pd.DataFrame:
        """A row for each run: its place, seed, status and every number of its summary."""
        return frame(self._runs)

    @property
    def failures(self) -> list[tuple[str, str]]:
        """The places and reasons of the runs that failed."""
        return list(self._failures)

    @property
    def points(self) -> pd.DataFrame:
        """A row for each point and quantity: mean, standard deviation, confidence interval of the mean, smallest and largest.

        Runs without a transition have no static friction and no reduction; ``runs_without_transition`` counts them.
        """
        return frame(self._tables["points"])

    @property
    def anisotropy(self) -> pd.DataFrame | None:
        """Dependence of friction on the direction of the drive, for a study over directions."""
        table = self._tables.get("anisotropy")
        return None if table is None else frame(table)

    def plot(self, quantity: str = "static_friction_star", ax: Axes | None = None, *, over: str | None = None) -> Axes:
        """Draw the means of a quantity with their confidence intervals over an axis of the study, as wide as a journal column (85 mm).

        Parameters
        ----------
        quantity
            A quantity of the column ``quantity`` of `points`.
        ax
            Axes to draw in, in their own style; by default new ones.
        over
            Column of the axis in `points`, by default that of the first. Each combination of the others is a curve.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from ._plot import plot_points

        return plot_points(self._tables["points"], self._axes, quantity, ax, over)

    def to_xarray(self) -> xr.Dataset:
        """The numbers of all runs over the axes of the study and the replicates, NaN where a run has none; references are omitted.

        Examples
        --------
        >>> slider = {"slider": {"blocks": [8, 8]}, "time": {"duration_star": 150}}
        >>> runs = Study(slider, axes={"drive.v_star": [0.02, 0.05]}, replicates=2).run(progress=False).to_xarray()
        >>> dict(runs.sizes)
        {'drive.v_star': 2, 'replicate': 2}
        >>> means = runs["static_friction_star"].mean("replicate")
        """
        return grid(self._runs, self._axes)

    def _repr_html_(self) -> str:
        counts = f"<b>{len(self._runs['point'])} runs, {len(self.failures)} failed</b>"
        return counts + table(*means_by_point(self._tables["points"], self._axes))

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(type(self), self.folder, self._tables, self._axes, self._failures)

    def __repr__(self) -> str:
        return f"StudyResults({len(self._runs['point'])} runs, {len(self.failures)} failed)"


def read_tables(folder: Path) -> dict[str, dict[str, list[Any]]]:
    """The tables of a study in its folder, by their names."""
    names = ("runs", "points", "anisotropy")
    return {name: read_table(folder / f"{name}.csv") for name in names if (folder / f"{name}.csv").exists()}


def executed(
    native: _slipfront.Study,
    kind: type[Results],
    folder: str | os.PathLike[str] | None,
    force: bool,
    progress: Progress,
    threads: int | None,
    look: Look | None = None,
) -> tuple[Results, dict[tuple[int, int, bool], list[float]], str | None]:
    """Make the runs that the folder of a study lacks, by default a temporary one. Return its results, the values of own quantities by run, and why
    no run has a value of the main quantity, if none has."""
    temporary = TemporaryFolder()
    with shown_runs(progress, native.name, lambda failed: f"{failed} failed" if failed else "") as show:
        path = temporary.path / native.name if folder is None else Path(folder)
        values, failures, why = native.execute((path, force), _threads(threads), look, show)
        results = kind.read(path, native.axes, failures)
        if folder is None:
            results.folder = None
    return results, values, why


def _axis(name: str, levels: Sequence[Any] | Mapping[str, Mapping[str, Any]], arrays: _toml.Arrays) -> str:
    if isinstance(levels, Mapping):
        of_level = ((level, _toml.by_key(keys)) for level, keys in levels.items())
        variants = "".join(f"{_toml.key(level)} = {_toml.value(keys, arrays)}\n" for level, keys in of_level)
        return f"[[axes]]\nname = {_toml.word(name)}\n[axes.variants]\n{variants}"
    if isinstance(levels, str) or not hasattr(levels, "__iter__"):
        raise TypeError(f"the levels of `{name}` are a list, such as [{levels!r}], not {levels!r}")
    if hasattr(levels, "__array__"):
        check_numbers(name, levels)
    listed = ", ".join(_toml.value(level, arrays, name) for level in levels)
    return f"[[axes]]\nkey = {_toml.word(name)}\nlist = [{listed}]\n"
