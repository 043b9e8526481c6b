"""Folders of the command: runs, interrupted runs, studies."""

from __future__ import annotations

import os
from pathlib import Path

from . import _slipfront
from ._case import Case
from ._run import FolderSource, Run
from ._simulation import Simulation, _threads
from ._study import StudyResults


class InterruptedRun:
    """The folder of a run that was stopped. It is only read: `slipfront run --resume` goes on in it.

    Attributes
    ----------
    folder
        Where it stands.
    simulation
        The run as it goes on from its latest checkpoint, in memory.
    """

    def __init__(self, folder: Path, case: Case, simulation: Simulation) -> None:
        self.folder, self.case, self.simulation = folder, case, simulation

    def __repr__(self) -> str:
        return f"InterruptedRun({self.folder}: step {self.simulation.steps} of {self.case.last_step})"


def open(folder: str | os.PathLike[str], *, verify: bool = True) -> Run | InterruptedRun | StudyResults:
    """Read a folder of the command.

    Parameters
    ----------
    folder
        That of a run, of a run that was stopped, or of a study, which that of the paper is as well.
    verify
        Hold what stands there against what was written.

    Returns
    -------
    Run, InterruptedRun or StudyResults

    Raises
    ------
    FolderError
        When it is none of these, or not as it was written.
    """
    path = Path(folder)
    kind = _slipfront.kind_of(path)
    if kind == "interrupted":
        native, running = _slipfront.interrupted(path, _threads(None))
        case = Case(native)
        return InterruptedRun(path, case, Simulation._of(case, running, None))
    if kind not in ("run", "study"):
        raise _slipfront.FolderError(f"{path} is not the folder of a run or of a study: name the one with its case.toml or study.toml")
    if verify:
        _slipfront.verify(path)
    if kind == "study":
        return StudyResults.read(path)
    native, read = _slipfront.read_run(path)
    return Run(Case(native), FolderSource(path, read), path)
