"""Runs: results of cases."""

from __future__ import annotations

import functools
import html
import json
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

import slipfront._dataset as _dataset
import slipfront._slipfront as _slipfront
from ._case import Case
from ._html import numbers, picture, with_error
from ._pickle import sealed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


class Source(Protocol):
    """Source of the numbers of a run: memory, or its folder."""

    def summary(self) -> str: ...
    def series(self) -> dict[str, Any]: ...
    def fields(self) -> dict[str, Any]: ...
    def kymograph(self) -> dict[str, Any] | None: ...
    def tables(self) -> dict[str, dict[str, Any] | None]: ...
    def save(self, folder: Path, force: bool) -> None: ...


class FolderSource:
    """A run that was read from its folder."""

    def __init__(self, folder: Path, read: dict[str, Any]) -> None:
        self._folder, self._read = folder, read

    def summary(self) -> str:
        return str(self._read["summary"])

    def series(self) -> dict[str, Any]:
        return dict(self._read["series"])

    def fields(self) -> dict[str, Any]:
        return dict(self._read["fields"])

    def kymograph(self) -> dict[str, Any] | None:
        return self._read.get("kymograph")

    def tables(self) -> dict[str, dict[str, Any] | None]:
        return dict(self._read["tables"])

    def save(self, folder: Path, force: bool) -> None:
        if folder.resolve() == self._folder.resolve():
            raise FolderError(f"{folder} is the folder that the run was read from: it is there already")
        manifest = json.loads((self._folder / "manifest.json").read_bytes())
        _slipfront.make_ready(folder, force)
        # The manifest is the last: without it a folder does not count as a complete run.
        for name in [*(file["name"] for file in manifest["files"]), "manifest.json"]:
            copied = folder / name
            copied.parent.mkdir(parents=True, exist_ok=True)
            if copied.exists():
                raise FolderError(f"{copied} does not belong to the earlier run there: move it away, or name another folder")
            shutil.copyfile(self._folder / name, copied)
        _slipfront.verify(folder)


class Run:
    """Results of a run: numbers, curve, fields, the slip front.

    Numbers with a star are dimensionless (Eq. 11). `summary` has the content of `summary.json`; the most common numbers are
    attributes. So is each table that only some runs have, such as `precursors`, the events of slip of a slider driven at an edge. It
    is a dataset like `series`, or None for a run without it.

    Examples
    --------
    >>> import slipfront as sf
    >>> round(sf.run("cases/circle.toml", progress=False).static_friction_star, 3)
    0.692
    """

    def __init__(self, case: Case, source: Source, folder: Path | None = None) -> None:
        self._case, self._source, self._folder = case, source, folder

    @property
    def case(self) -> Case:
        """The case that was run."""
        return self._case

    @property
    def folder(self) -> Path | None:
        """The folder from which the run was read, or to which it was saved."""
        return self._folder

    @property
    def summary(self) -> dict[str, Any]:
        """The numbers, under the keys of `summary.json`."""
        return dict(json.loads(self._summary))

    @property
    def static_friction_star(self) -> float:
        """mu_s*, the first peak of mu*; without a `transition` its largest value, which is a lower bound."""
        return float(self.summary["static_friction_star"])

    @property
    def static_friction(self) -> float:
        """mu_s, the static friction coefficient F_T/F_N; a lower bound without a `transition`."""
        return float(self.summary["static_friction"])

    @property
    def kinetic_friction_star(self) -> float | None:
        """mu_k*, the mean of mu* over the kinetic window; None if the run has none."""
        return self._optional("kinetic_friction_star")

    @property
    def kinetic_friction_star_uncertainty(self) -> float | None:
        """Standard error of mu_k*; None if the window supports none (see `warnings`)."""
        return self._optional("kinetic_friction_star_uncertainty")

    @property
    def kinetic_friction(self) -> float | None:
        """mu_k, the kinetic friction coefficient F_T/F_N."""
        return self._optional("kinetic_friction")

    @property
    def onset_time_star(self) -> float:
        """t_s*, the time of the first peak of mu*."""
        return float(self.summary["onset_time_star"])

    @property
    def onset_time_s(self) -> float:
        """t_s, the time of the first peak, s."""
        return float(self.summary["onset_time_s"])

    @property
    def first_slip_time_star(self) -> float | None:
        """t* of the first slip of a block in contact; None if none slipped."""
        return self._optional("first_slip_time_star")

    @property
    def first_slip_time_s(self) -> float | None:
        """Time of the first slip of a block in contact, s; None if none slipped."""
        return self._optional("first_slip_time_s")

    @property
    def sliding_percent_max(self) -> float:
        """Largest share of sliding blocks N*, %."""
        return float(self.summary["sliding_percent_max"])

    @property
    def transition(self) -> bool:
        """Whether mu* fell at least half-way to the steady level after its first peak and stays below it."""
        return bool(self.summary["transition"])

    @property
    def nucleation_sites(self) -> int | None:
        """Sites at which slip has nucleated; None without a transition."""
        found = self.summary["nucleation_sites"]
        return None if found is None else int(found)

    @property
    def front_share(self) -> float | None:
        """Share of the windows of 7 x 7 blocks through which a slip front passes."""
        return self._optional("front_share")

    @property
    def front_speed_c_s(self) -> float | None:
        """Median speed of the slip front over the speed of long shear waves; None if it passes less than half of the windows."""
        return self._optional("front_speed_c_s")

    @property
    def front_speed_m_s(self) -> float | None:
        """Median speed of the slip front, m/s; None if it passes less than half of the windows."""
        return self._optional("front_speed_m_s")

    @property
    def front_duration_star(self) -> float | None:
        """Duration from 5 to 95 % of the first slips, t*."""
        return self._optional("front_duration_star")

    @property
    def front_duration_s(self) -> float | None:
        """Duration from 5 to 95 % of the first slips, s."""
        return self._optional("front_duration_s")

    @property
    def texture_percent(self) -> float:
        """Textured area A* as meshed, %."""
        return float(self.summary["texture_percent"])

    @property
    def energy_error(self) -> float:
        """Energy that is not accounted for, relative to the energy put in."""
        return float(self.summary["energy_error"])

    @property
    def steps(self) -> int:
        """Steps done."""
        return int(self.summary["steps"])

    @property
    def warnings(self) -> list[str]:
        """Warnings that a reader should know before trusting the numbers."""
        return [str(warning) for warning in self.summary["warnings"]]

    @property
    def series(self) -> xr.Dataset:
        """The recorded curve over t*: the columns of `series.csv` with units; a dictionary of arrays without xarray."""
        return self._series.copy()

    @property
    def fields(self) -> xr.Dataset:
        """Fields at the snapshots, (time, y, x) in SI units, and constant arrays, (y, x): the content of `fields.nc`."""
        return self._fields.copy()

    @property
    def kymograph(self) -> xr.Dataset | None:
        """The share of sliding blocks over time and place along the drive; None in folders of old versions."""
        return None if self._kymograph is None else self._kymograph.copy()

    @property
    def texture(self) -> npt.NDArray[np.bool_]:
        """Whether each block is textured, (N_y, N_x), the lowest row first."""
        return self._case.textured

    @property
    def front(self) -> npt.NDArray[np.float64]:
        """t* of the first slip of every block that the fields keep, (y, x); NaN where a block never slid. The array is read-only."""
        return _dataset.read_only(self._arrays["first_slip_time_star"])

    def save(self, folder: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Write the folder of the run, byte for byte as `slipfront run` does.

        Parameters
        ----------
        folder
            A new or empty folder.
        force
            Replace the files of an earlier run there, and nothing else.

        Returns
        -------
        pathlib.Path
            The folder.
        """
        path = Path(folder)
        self._source.save(path, force)
        self._folder = path
        return path

    def plot(
        self, kind: str = "friction", ax: Axes | None = None, *, instant: str | int = -1, label: str | None = None
    ) -> Axes:
        """Draw the run with matplotlib, as wide as a journal column (85 mm).

        Parameters
        ----------
        kind
            ``"friction"``: mu* over t* with the instants A to F; ``"front"``: when each block first slid; ``"kymograph"``: the share of
            the blocks that slide over t* and along the drive; or the name of a field, such as ``"traction"``.
        ax
            Axes to draw in, in their own style; by default new ones.
        instant
            The snapshot of a field: a letter, or its number.
        label
            Name of the curve in a legend.

        Returns
        -------
        matplotlib.axes.Axes
        """
        from ._plot import plot

        return plot(self, kind, ax, instant, label)

    @property
    def precursors(self) -> xr.Dataset | None:
        """The events of slip of a slider that is driven at an edge; None for another drive."""
        return self._table("precursors")

    @property
    def events(self) -> xr.Dataset | None:
        """The catalogue of events of slip; None unless ``output.events`` is true."""
        return self._table("events")

    def __repr__(self) -> str:
        return f"Run({self._case.name}: {', '.join(f'{name} = {value}' for name, value in self._main_values())})"

    def _repr_html_(self) -> str:
        rows = [*self._main_values(), *(("warning", warning) for warning in self.warnings)]
        return f"<b>{html.escape(self._case.name)}</b>{picture(self.texture)}{numbers(rows)}"

    def _main_values(self) -> list[tuple[str, str]]:
        kinetic, error = self.kinetic_friction_star, self.kinetic_friction_star_uncertainty
        bound = "" if self.transition else "at least "
        values = [("mu_s*", f"{bound}{self.static_friction_star:.4g}")]
        if kinetic is not None:
            values.append(("mu_k*", with_error(kinetic, error)))
        return [*values, ("t_s*", f"{self.onset_time_star:.4g}"), ("A*", f"{self.texture_percent:.4g} %")]

    # Results are kept after the first use. Each caller gets new datasets with shared, read-only arrays.

    @functools.cached_property
    def _summary(self) -> str:
        return self._source.summary()

    @functools.cached_property
    def _arrays(self) -> dict[str, Any]:
        return self._source.fields()

    @functools.cached_property
    def _series(self) -> xr.Dataset:
        return _dataset.table(self._source.series())

    @functools.cached_property
    def _fields(self) -> xr.Dataset:
        return _dataset.fields(self._arrays)

    @functools.cached_property
    def _kymograph(self) -> xr.Dataset | None:
        arrays = self._source.kymograph()
        return None if arrays is None else _dataset.kymograph(arrays, self._arrays["time_unit_s"])

    def _table(self, name: str) -> xr.Dataset | None:
        table = self._tables[name]
        return None if table is None else table.copy()

    @functools.cached_property
    def _tables(self) -> dict[str, xr.Dataset | None]:
        tables = self._source.tables().items()
        return {name: None if columns is None else _dataset.table(columns) for name, columns in tables}

    def _optional(self, key: str) -> float | None:
        found = self.summary[key]
        return None if found is None else float(found)

    def __reduce__(self) -> tuple[Any, ...]:
        read = {
            "summary": self._source.summary(),
            "series": self._source.series(),
            "fields": self._arrays,
            "kymograph": self._source.kymograph(),
            "tables": self._source.tables(),
        }
        return sealed(_unpickled, self._case, read)


class _Unsaved(FolderSource):
    """A run that was pickled: its numbers without its files."""

    def save(self, folder: Path, force: bool) -> None:
        raise FolderError("a run that was pickled has no files: save it first, or run its case again")


def _unpickled(case: Case, read: dict[str, Any]) -> Run:
    return Run(case, _Unsaved(Path(), read))


FolderError = _slipfront.FolderError
