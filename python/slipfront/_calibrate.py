"""Calibrations: keys of a case from measured records."""

from __future__ import annotations

import csv
import dataclasses
import json
import os
import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

import slipfront._slipfront as _slipfront
from ._case import Case, CaseLike, Overrides
from ._finite import check_numbers
from ._html import table
from ._keys import CalibrationKeys, InstrumentKeys, Range
from ._pickle import sealed
from ._progress import shown_runs
from ._project import of_case, of_file
from ._simulation import _threads
from ._tables import frame, read_table
from ._temporary import TemporaryFolder

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from typing_extensions import Unpack


class Columns(Protocol):
    """Columns by name: a mapping of arrays, or a DataFrame."""

    def items(self) -> Iterable[tuple[Any, Any]]:
        """Names and columns."""


Found = TypeVar("Found")

Record: TypeAlias = str | os.PathLike[str] | Columns | tuple[npt.ArrayLike, npt.ArrayLike]
"""A record: the path of a text table or of a workbook; its columns by name, found as in such a table, with or without their units; or two
arrays, of the columns `x` and `y`."""

def _without_folder(text: str, folder: Path) -> str:
    """A sentence that names a record in memory, not the file that passes it on."""
    hidden = re.escape(f"{folder}{os.sep}")
    return re.sub(hidden, "", re.sub(rf"{hidden}(record \d+)\.csv", r"\1", text))


@dataclasses.dataclass(frozen=True)
class Interval:
    """A key of the case as estimated from records.

    Attributes
    ----------
    median
        The value is as likely above it as below.
    low, high
        Ends of the interval that contains the value with a probability of 90 %.
    unit
        Unit of the numbers, if any.
    is_determined
        Whether the records determine it.
    belongs_to_block
        Whether it leaves the interval on blocks of half the size, so that it is not a value of the material.
    depends_on_step
        Whether it leaves the interval at a finer time step.
    """

    median: float
    low: float
    high: float
    unit: str | None
    is_determined: bool
    belongs_to_block: bool
    depends_on_step: bool


@dataclasses.dataclass(frozen=True)
class RecordCheck:
    """Tests of whether the model can reproduce records.

    Attributes
    ----------
    reasons
        Sentences that say why it cannot; empty without evidence against it.
    clipped, misfit, comparison, closest
        Numbers of the tests, as in `CalibrationResults`.
    """

    reasons: list[str]
    clipped: dict[str, Any] | None
    misfit: dict[str, Any]
    comparison: dict[str, Any]
    closest: dict[str, Any] | None

    @property
    def is_refused(self) -> bool:
        """Whether the model cannot reproduce the records; about 4 % of records from the model itself are refused, too."""
        return bool(self.reasons)


class Calibration:
    """A calibration: unknown keys of a case, and known properties of records.

    Parameters
    ----------
    case
        The case, a dictionary of its tables or the path of its file; or the path of a calibration file, with `overrides` alone.
    overrides
        Keys of the case to change.
    unknowns
        The keys to estimate, each with its range.
    noise
        Standard deviation of the noise of a record, as a share of its mean friction.
    x, y
        Columns of records: times or displacements, by default ``time_s``; forces, or coefficients if their unit is 1, by default
        ``force_n``. Names end in the unit, or `x_unit` and `y_unit` give it.
    instrument
        The measuring chain between friction and the record, as the table ``[instrument]``: load cell, filter, sampling, gain, offset
        and range. Unknowns may be keys of it, such as ``"instrument.gain"``.
    keys
        Other keys of the table ``[calibrate]``, such as ``against``, ``runs``, ``finer_runs`` or ``next``; ``from`` is ``from_``.

    Examples
    --------
    >>> import slipfront
    >>> slider = {"slider": {"blocks": [6, 6]}, "drive": {"v_star": 0.1}, "time": {"step": 0.4}}
    >>> measured = slipfront.run({**slider, "output": {"series": 1}}, progress=False).series
    >>> unknowns = {"friction.mu_static": (0.3, 0.9), "drive.stiffness_star": (0.3, 0.9)}
    >>> calibration = Calibration(slider, unknowns=unknowns, noise=0.01, runs=200, finer_runs=0)
    >>> record = {"time_s": measured["time_s"], "force_n": measured["friction_force_n"]}
    >>> fit = calibration.fit(record, progress=False)
    >>> fit.intervals["drive.stiffness_star"].is_determined
    True

    Only the test of whether the model can reproduce such a record:

    >>> calibration.check(record, progress=False).is_refused
    False

    Expected widths of the intervals, before there is a record:

    >>> calibration.plan(until="10 ns", progress=False)["as planned"]["drive.stiffness_star"] < 0.8
    True
    """

    def __init__(
        self,
        case: CaseLike,
        overrides: Overrides | None = None,
        *,
        unknowns: Mapping[str, Range] | None = None,
        noise: float | None = None,
        x: str | None = None,
        y: str | None = None,
        instrument: InstrumentKeys | None = None,
        name: str | None = None,
        **keys: Unpack[CalibrationKeys],
    ) -> None:
        # Records at the same times share their runs.
        self._training = TemporaryFolder()
        given = (unknowns, noise, x, y, instrument, name)
        if isinstance(case, (str, os.PathLike)) and all(one is None for one in given) and not keys:
            self._native, self._arrays = of_file(_slipfront.Calibration, case, overrides)
            return
        if unknowns is None or noise is None:
            raise ValueError("give a case with `unknowns` and `noise`, or the path of a calibration file alone")
        records = {"x": x or "time_s", "y": y or "force_n"}
        # `from` is a keyword of Python.
        others = {key.removesuffix("_"): value for key, value in keys.items()}
        tables: dict[str, Mapping[str, Any]] = {"calibrate": {"unknowns": unknowns, "noise": noise, **records, **others}}
        if instrument is not None:
            tables["instrument"] = instrument
        self._native, self._arrays = of_case(_slipfront.Calibration, case, overrides, tables, name, "calibration")

    @property
    def name(self) -> str:
        """Name of the calibration."""
        return self._native.name

    def fit(
        self,
        *records: Record,
        folder: str | os.PathLike[str] | None = None,
        training: str | os.PathLike[str] | None = None,
        force: bool = False,
        progress: bool | Callable[[int, int], object] | None = None,
        threads: int | None = None,
    ) -> CalibrationResults:
        """Estimate the unknowns from records.

        Parameters
        ----------
        records
            One record, or several in the order of ``records`` of the calibration.
        folder
            A folder of results, byte for byte that of `slipfront calibrate`, in which a stopped call continues. By default results are in
            memory.
        training
            A folder of training runs, which fits of other records at the same times then share. In memory, fits of this object share
            them.
        force
            Replace files of the results that were edited since they were written.
        progress
            True for a bar, False for none, None for one in terminals and notebooks, or a function of the numbers of finished runs and of
            all.
        threads
            Runs in parallel, by default one per core. Results do not depend on it.

        Raises
        ------
        CaseError
            When a record cannot be read, or the ranges exceed the bounds of the case.

        Warns
        -----
        UserWarning
            When the model cannot reproduce these records, and about lines without numbers at the end of a record.
        """
        temporary = TemporaryFolder()
        path = temporary.path / self.name if folder is None else Path(folder)
        if training is None and folder is None:
            training = self._training.path
        kept = None if training is None else Path(training)
        notes = self._watched(records, temporary, progress, threads, partial(self._native.execute, (path, force), kept))
        results = CalibrationResults.read(path, None if folder is None else path)
        if results.is_refused:
            notes.append("the model cannot reproduce these records, so its numbers do not describe them: `text` gives the reasons, and what to check")
        for note in notes:
            warnings.warn(_without_folder(note, temporary.path), stacklevel=2)
        return results

    def check(
        self,
        *records: Record,
        training: str | os.PathLike[str] | None = None,
        progress: bool | Callable[[int, int], object] | None = None,
        threads: int | None = None,
    ) -> RecordCheck:
        """Test whether the model can reproduce records, as `fit` does, without blocks of half the size and next experiments.

        Training runs are shared with fits of this object in memory, or are kept in a folder.

        Parameters
        ----------
        records, training, progress, threads
            See `fit`.

        Raises
        ------
        CaseError
            When a record cannot be read, or the ranges exceed the bounds of the case.

        Warns
        -----
        UserWarning
            About lines without numbers at the end of a record.
        """
        temporary = TemporaryFolder()
        kept = self._training.path if training is None else Path(training)
        work = partial(self._native.check, temporary.path / self.name, kept)
        reasons, tests, notes = self._watched(records, temporary, progress, threads, work)
        for note in notes:
            warnings.warn(_without_folder(note, temporary.path), stacklevel=2)
        return RecordCheck(reasons, **json.loads(tests))

    def plan(
        self,
        *records: Record,
        until: str | None = None,
        values: int = 400,
        progress: bool | Callable[[int, int], object] | None = None,
        threads: int | None = None,
    ) -> dict[str, dict[str, float] | str]:
        """Simulate records before any is measured, and records of longer, slower and faster experiments.

        Parameters
        ----------
        records
            Records with the times at which friction is simulated; their values are ignored.
        until, values
            End of the planned records with its unit, such as ``"20 s"``, and their number of values, instead of `records`.
        progress, threads
            See `fit`.

        Returns
        -------
        dict
            For each experiment the expected width of the 90 % interval of every unknown, as a share of its range. From 0.8 on, the
            records do not determine the unknown. If the experiment is impossible, the reason.

        Raises
        ------
        CaseError
            When a record cannot be read, or the ranges exceed the bounds of the case.
        """
        if bool(records) == (until is not None):
            raise ValueError("give either records or `until`, the end of the planned ones, such as '20 s'")
        planned = None if until is None else (until, values)
        work = partial(self._native.plan, planned)
        found = json.loads(self._watched(records, TemporaryFolder(), progress, threads, work))
        keys = found["unknowns"]
        return {
            experiment["name"]: experiment["impossible"]
            if experiment["widths"] is None
            else dict(zip(keys, experiment["widths"], strict=True))
            for experiment in found["experiments"]
        }

    def _watched(
        self,
        records: Sequence[Record],
        temporary: TemporaryFolder,
        progress: bool | Callable[[int, int], object] | None,
        threads: int | None,
        work: Callable[[list[Path], int, Callable[[int, int], object]], Found],
    ) -> Found:
        """Do some work on records; errors do not name their files in a temporary folder."""
        paths = [self._path(record, temporary.path / f"record {number}.csv") for number, record in enumerate(records, 1)]
        with shown_runs(progress, self.name) as show:
            try:
                return work(paths, _threads(threads), show)
            except _slipfront.CaseError as error:
                error.args = (_without_folder(str(error), temporary.path),)
                raise

    def _path(self, record: Record, path: Path) -> Path:
        """Path of a record; a record given as columns is written there."""
        if isinstance(record, (str, os.PathLike)):
            return Path(record)
        columns = dict(zip(self._native.columns, record, strict=True)) if isinstance(record, tuple) else record
        arrays = {str(name): np.asarray(column) for name, column in columns.items()}
        lengths = {len(array) for array in arrays.values() if array.ndim == 1}
        if len(lengths) != 1:
            raise ValueError(f"the columns of a record must have the same length: {', '.join(arrays)} have {sorted(lengths)} values")
        for name, array in arrays.items():
            if array.dtype.kind == "f" and name.startswith(tuple(self._native.columns)):
                # Values at the end that are not numbers are skipped with a note, as in a file.
                ends = np.flatnonzero(np.isfinite(array))
                check_numbers(name, array[: ends[-1] + 1 if len(ends) else None])
        with path.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(name for name, array in arrays.items() if array.ndim == 1)
            table.writerows(zip(*(array.tolist() for array in arrays.values() if array.ndim == 1), strict=True))
        return path

    def __repr__(self) -> str:
        return f"Calibration({self.name})"


class CalibrationResults:
    """Estimates of the unknown keys from records.

    Attributes
    ----------
    folder
        Its path; None in memory.
    intervals
        Estimate of every key.
    posterior
        For every key, draws from the joint posterior.
    text
        The results, as the command prints them.
    """

    def __init__(
        self,
        folder: Path | None,
        found: dict[str, Any],
        posterior: dict[str, npt.NDArray[np.float64]],
        text: str,
        bands: list[dict[str, list[Any]]],
    ) -> None:
        self.folder, self.posterior, self.text = folder, posterior, text
        self._found, self._bands = found, bands
        self.intervals = {
            estimate["key"]: Interval(
                median=estimate["median"],
                low=estimate["interval"][0],
                high=estimate["interval"][1],
                unit=estimate["unit"],
                is_determined=estimate["is_determined"],
                belongs_to_block=estimate["belongs_to_block"],
                depends_on_step=estimate["depends_on_step"],
            )
            for estimate in found["unknowns"]
        }

    @classmethod
    def read(cls, folder: Path, kept: Path | None) -> CalibrationResults:
        """Results in a folder, which is kept as `kept` or removed afterwards."""
        found = json.loads((folder / "calibration.json").read_bytes())
        points = np.loadtxt(folder / "posterior.csv", delimiter=",", skiprows=1, ndmin=2)
        posterior = {estimate["key"]: points[:, number] for number, estimate in enumerate(found["unknowns"])}
        bands = [read_table(folder / f"band-{number}.csv") for number in range(1, len(found["within_band_percent"]) + 1)]
        return cls(kept, found, posterior, (folder / "calibration.txt").read_text(encoding="utf-8"), bands)

    @property
    def unknowns(self) -> pd.DataFrame:
        """A row for each key: median, ends of the interval, unit, whether the records determine it, and whether it depends on block and step."""
        names = [field.name for field in dataclasses.fields(Interval)]
        columns = {name: [getattr(interval, name) for interval in self.intervals.values()] for name in names}
        return frame({"key": list(self.intervals), **columns})

    @property
    def undetermined(self) -> list[str]:
        """Keys that the records do not determine."""
        return [key for key, interval in self.intervals.items() if not interval.is_determined]

    @property
    def pairs(self) -> list[tuple[str, str, float]]:
        """Keys that are determined only together, and the correlation of their errors."""
        return [(*pair["keys"], pair["correlation"]) for pair in self._found["pairs"]]

    @property
    def is_refused(self) -> bool:
        """Whether the model cannot reproduce the records; its numbers then do not describe them."""
        return bool(self._found["is_refused"])

    @property
    def clipped(self) -> dict[str, Any] | None:
        """Values equal to the largest of a record, more than by chance, as from a sensor at the end of its range: number of the record, from 0,
        number of the values, and their share. None if there are none, or if `range` of the instrument is given."""
        found = self._found["clipped"]
        return None if found is None else dict(found)

    @property
    def misfit(self) -> dict[str, Any]:
        """The records compared with the training runs: an interval of their drift as a share of friction, and their distance from the runs.
        Further numbers are the mean friction in the second half of a record, and its least and largest value in the training runs, for the
        record with the mean farthest outside of them. `comparison` and `closest` are the other tests."""
        return dict(self._found["misfit"])

    @property
    def comparison(self) -> dict[str, Any]:
        """The records compared with runs of the calibrated model. `rank` is the share of the runs that are at least as far from the others as
        the records are. `distance` is that of the records from the runs, over the one that half of the runs exceed. `differs_in` lists
        differences of the records, with their mean square in standard deviations of the runs, the largest first."""
        return dict(self._found["comparison"])

    @property
    def closest(self) -> dict[str, Any] | None:
        """Differences between the records and the closest curve of the model; None where random coefficients make curves of the same keys
        differ. `noise_ratio` is their root mean square over the noise. `correlation` is that of neighbouring values; above `most_correlated`
        they are not noise. `share` is the compared part of the records, from their beginning."""
        found = self._found["closest"]
        return None if found is None else dict(found)

    def plot(self, record: int = 1, ax: Axes | None = None) -> Axes:
        """Draw a record over the band of the calibrated model, as wide as a journal column (85 mm): the picture `band-1.png` of the command.

        Parameters
        ----------
        record
            Number of the record, from 1.
        ax
            Axes to draw in, in their own style; by default new ones.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from ._plot import plot_band

        if not 1 <= record <= len(self._bands):
            raise ValueError(f"there is no record {record}: the records of this calibration are 1 to {len(self._bands)}")
        return plot_band(self._bands[record - 1], ax)

    @property
    def case(self) -> Case:
        """The case with the medians, in its folder; in memory, `Case.replace` sets the keys."""
        if self.folder is None:
            raise LookupError("a calibration in memory has no case file: set the keys with Case.replace")
        return Case.load(self.folder / "case.toml")

    def to_dict(self) -> dict[str, Any]:
        """The content of `calibration.json`."""
        return dict(json.loads(json.dumps(self._found)))

    def _repr_html_(self) -> str:
        def row(key: str, found: Interval) -> list[str]:
            doubts = {"does not describe the records": True} if self.is_refused else {
                "not determined": not found.is_determined,
                "belongs to the block": found.belongs_to_block,
                "depends on the time step": found.depends_on_step,
            }
            unit = found.unit or ""
            interval = f"{found.low:.4g} to {found.high:.4g} {unit}".strip()
            return [key, f"{found.median:.4g} {unit}".strip(), interval, ", ".join(doubt for doubt, is_so in doubts.items() if is_so)]

        rows = [row(key, found) for key, found in self.intervals.items()]
        refused = "<p>The model cannot reproduce these records, so its numbers do not describe them.</p>" if self.is_refused else ""
        return refused + table(["key", "median", "90 % interval", ""], rows)

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(type(self), self.folder, self._found, self.posterior, self.text, self._bands)

    def __repr__(self) -> str:
        return self.text.rstrip()
