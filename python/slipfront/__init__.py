"""Friction of micro-textured surfaces: the lattice spring-block model of the transition from static to kinetic friction.

>>> result = run("cases/circle.toml", {"drive.v_star": 0.05}, progress=False)
>>> round(result.static_friction_star, 2)
0.73
"""

from ._calibrate import Calibration, CalibrationResults, Interval, RecordCheck
from ._case import Case, CaseError
from ._cite import cite
from ._converge import Convergence, QuantityOnMeshes, converge
from ._design import Design, DesignResults, Largest, Least, Value
from ._export import export
from ._map import map as map
from ._open import InterruptedRun, PaperResults, open_run, open_study
from ._open import open as open
from ._run import FolderError, Run
from ._simulation import Simulation, run
from ._slipfront import ForkError, RunError, __version__
from ._study import Study, StudyResults

# Without `map` and `open`, so that `from slipfront import *` leaves the built-in functions.
__all__ = [
    "Calibration",
    "CalibrationResults",
    "Case",
    "CaseError",
    "Convergence",
    "Design",
    "DesignResults",
    "FolderError",
    "ForkError",
    "InterruptedRun",
    "Interval",
    "Largest",
    "Least",
    "PaperResults",
    "QuantityOnMeshes",
    "RecordCheck",
    "Run",
    "RunError",
    "Simulation",
    "Study",
    "StudyResults",
    "Value",
    "__version__",
    "cite",
    "converge",
    "export",
    "open_run",
    "open_study",
    "run",
]
