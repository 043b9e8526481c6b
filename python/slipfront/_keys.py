"""Keys of the tables of study, design and calibration files, as arguments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Protocol, TypeAlias, TypedDict

import numpy.typing as npt


class Quantity(Protocol):
    """A quantity of pint."""

    @property
    def magnitude(self) -> Any: ...
    @property
    def units(self) -> Any: ...


Amount: TypeAlias = str | Quantity
"""A quantity with its unit, as a text such as ``"3 um"`` or of pint."""

Table: TypeAlias = Mapping[str, Any]
"""Keys of a case and their values, or a table of a file."""

Range: TypeAlias = Sequence[float] | Sequence[str] | Mapping[str, Any]
"""Both ends of a range, as numbers or texts with a unit, or ``{"from": 0.03, "to": 0.5, "scale": "log"}``."""


class UntilKeys(TypedDict, total=False):
    """The table ``until`` of a study."""

    key: str
    half_width: float
    confidence: float
    min: int
    max: int


class StudyKeys(TypedDict, total=False):
    """Keys of ``[study]`` other than `replicates`."""

    reference: Table
    keep: Literal["all", "none", "failed"]
    until: UntilKeys


class WritingKeys(TypedDict, total=False):
    """The table ``writing`` of a design."""

    line_spacing: Amount
    max_length: Amount


class DesignKeys(TypedDict, total=False):
    """Keys of ``[design]`` other than `wish` and `coverage`."""

    tolerance: float | Amount
    feature: Amount
    feature_blocks: int
    gap: Amount
    gap_blocks: int
    mirror: Literal["none", "x", "y", "both"]
    copies: Sequence[int]
    forbidden: Sequence[Table]
    max_features: int
    writing: WritingKeys
    cases: Sequence[Table]
    judge_by: Literal["mean", "worst"]
    runs: int
    start: int
    drafts_at_once: int
    unknowns: Mapping[str, Range]
    starts: Sequence[Sequence[Table]]
    front: Sequence[float] | npt.NDArray[Any]


class InstrumentKeys(TypedDict, total=False):
    """The table ``[instrument]``."""

    filter: Literal["first_order", "butterworth", "moving_mean"]
    order: int
    cutoff: Amount
    time: Amount
    mass: Amount
    stiffness: Amount
    damping_ratio: float
    sampling: Amount
    gain: float
    offset: float | Amount
    range: Sequence[float] | Sequence[str]


class CalibrationKeys(TypedDict, total=False):
    """Keys of ``[calibrate]`` other than `unknowns`, `noise`, `x` and `y`; `from_` is ``from``, a keyword of Python."""

    x_unit: str
    y_unit: str
    header_line: int
    decimal: Literal["point", "comma"]
    separator: Literal["comma", "semicolon", "tab", "blank"]
    segment: int
    against: Literal["time", "displacement"]
    y_factor: float
    y_offset: float
    shift: Amount
    from_: Amount
    to: Amount
    records: Sequence[Table]
    runs: int
    finer_runs: int
    next: Sequence[Table]
