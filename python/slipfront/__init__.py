"""Friction of micro-textured surfaces: the lattice spring-block model of the transition from static to kinetic friction.

>>> case = Case.load("cases/circle.toml", {"drive.v_star": 0.05})
>>> result = run(case, progress=False)
>>> round(result.static_friction_star, 2)
0.73
"""

from ._case import Case, CaseError
from ._cite import cite
from ._open import InterruptedRun, PaperResults, open
from ._run import FolderError, Run
from ._simulation import Simulation, run
from ._slipfront import RunError, __version__
from ._study import Study, StudyResults

__all__ = [
    "Case",
    "CaseError",
    "FolderError",
    "InterruptedRun",
    "PaperResults",
    "Run",
    "RunError",
    "Simulation",
    "Study",
    "StudyResults",
    "__version__",
    "cite",
    "open",
    "run",
    "study",
]


def study(path: str, folder: str | None = None, progress: bool | None = None, threads: int | None = None) -> StudyResults:
    """Run the study of a study file; `Study.run` says more.

    Parameters
    ----------
    path
        The study file.
    folder
        Where its results go, and a study that was stopped goes on; in memory unless it is given.
    progress
        As of `run`.
    threads
        Runs at once, one per core unless given.
    """
    return Study(path).run(folder, progress=progress, threads=threads)
