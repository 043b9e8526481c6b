"""Folders of the command: runs, interrupted runs, studies, the paper."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import slipfront._slipfront as _slipfront
from ._case import Case
from ._converge import Convergence
from ._calibrate import CalibrationResults
from ._design import DesignResults
from ._pickle import sealed
from ._run import FolderSource, Run
from ._simulation import Simulation, _threads
from ._study import StudyResults
from ._tables import frame, read_table

if TYPE_CHECKING:
    import pandas as pd

Results = TypeVar("Results", Run, StudyResults)


class InterruptedRun:
    """The folder of a stopped run, for reading; `slipfront run --resume` continues it.

    Attributes
    ----------
    folder
        Its path.
    simulation
        The run, continued in memory from its latest checkpoint.
    """

    def __init__(self, folder: Path, case: Case, simulation: Simulation) -> None:
        self.folder, self.case, self.simulation = folder, case, simulation

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(type(self), self.folder, self.case, self.simulation)

    def __repr__(self) -> str:
        return f"InterruptedRun({self.folder}: step {self.simulation.steps} of {self.case.last_step})"


class PaperResults:
    """The folder of `slipfront paper`: the figures of the paper and its claims as tables.

    Attributes
    ----------
    folder
        Its path.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def claims(self) -> pd.DataFrame:
        """A row for each claim of the paper: the measured number, its interval, the criterion, the verdict."""
        return frame(read_table(self.folder / "claims.csv"))

    @property
    def figures(self) -> dict[str, pd.DataFrame]:
        """The data of every panel, under the name of its picture."""
        panels = sorted(self.folder.glob("*.png"))
        return {panel.stem: frame(read_table(panel.with_suffix(".csv"))) for panel in panels if panel.with_suffix(".csv").exists()}

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(type(self), self.folder)

    def __repr__(self) -> str:
        return f"PaperResults({self.folder})"


def open_run(folder: str | os.PathLike[str], *, verify: bool = True) -> Run:
    """Read the folder of a run.

    Parameters
    ----------
    folder, verify
        See `open`.

    Raises
    ------
    FolderError
        When it is not the folder of a complete run, or was changed.
    """
    return _open_as(Run, "a complete run", folder, verify)


def open_study(folder: str | os.PathLike[str], *, verify: bool = True) -> StudyResults:
    """Read the folder of a study, or of `slipfront converge`, a study over meshes.

    Parameters
    ----------
    folder, verify
        See `open`.

    Raises
    ------
    FolderError
        When it is not the folder of a study, or was changed.
    """
    return _open_as(StudyResults, "a study", folder, verify)


def _open_as(kind: type[Results], called: str, folder: str | os.PathLike[str], verify: bool) -> Results:
    found = open(folder, verify=verify)
    if isinstance(found, kind):
        return found
    remedy = ": continue it with `slipfront run --resume`" if isinstance(found, InterruptedRun) else ""
    raise _slipfront.FolderError(f"{folder} is not the folder of {called} but holds {found!r}{remedy}")


def open(folder: str | os.PathLike[str], *, verify: bool = True) -> Run | InterruptedRun | StudyResults | DesignResults | CalibrationResults | PaperResults:
    """Read a folder of the command; for a known kind, `open_run` and `open_study` have its type.

    Parameters
    ----------
    folder
        The folder of a run, of a stopped run, of a study, of `slipfront converge`, of `slipfront design`, of `slipfront calibrate`, or of
        `slipfront paper`.
    verify
        Compare the folder with its checksums. The checkpoint of an interrupted run is always verified. Figures of the paper are not drawn
        again.

    Returns
    -------
    Run, InterruptedRun, StudyResults, DesignResults, CalibrationResults, PaperResults, or Convergence for a folder of `slipfront converge`

    Raises
    ------
    FolderError
        When it is none of these, or was changed; for a missing folder it is also a `FileNotFoundError`.
    """
    path = Path(folder)
    if not path.exists():
        raise MissingFolderError(f"there is no folder {path}")
    kind = _slipfront.kind_of(path)
    if kind == "interrupted":
        native, running = _slipfront.interrupted(path, _threads(None))
        case = Case._of(native)
        return InterruptedRun(path, case, Simulation._of(case, running, None))
    if kind == "paper" and (path / "claims.csv").exists():
        if verify:
            _slipfront.verify(path)
        return PaperResults(path)
    if kind not in ("run", "study", "meshes", "design", "calibration"):
        raise _slipfront.FolderError(f"{path} is not the folder of a run, of a study, of a design, of a calibration, or of a paper that is finished: name one with a case.toml, a study.toml, a design.json, a calibration.json or a claims.csv")
    if verify:
        _slipfront.verify(path)
    if kind in ("study", "meshes"):
        results = StudyResults if kind == "study" else Convergence
        return results.read(path, _slipfront.Study.of_folder(path).axes)
    if kind == "design":
        return DesignResults.read(path, path)
    if kind == "calibration":
        return CalibrationResults.read(path, path)
    native, read = _slipfront.read_run(path)
    return Run(Case._of(native), FolderSource(path, read), path)


class MissingFolderError(_slipfront.FolderError, FileNotFoundError):
    """Error: a folder is missing."""
