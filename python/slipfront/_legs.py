"""Legs of a simulation between changes of its case."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from ._case import Case


@dataclasses.dataclass(frozen=True)
class Past:
    """The legs of a simulation before its current one.

    Attributes
    ----------
    legs
        The case of each leg, and the number of its steps.
    curves
        The columns of the series of each leg alone, and the counts before it.
    counts
        The counts of all legs together, by the columns of the series that count from the start.
    origin
        Position of the drive at their end, block by block, m.
    """

    legs: tuple[tuple[Case, int], ...] = ()
    curves: tuple[tuple[dict[str, Any], Mapping[str, float]], ...] = ()
    counts: Mapping[str, float] = dataclasses.field(default_factory=dict)
    origin: npt.NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros((2, 1, 1)))

    def counted(self, column: str) -> float:
        """The sum over the legs of a column that counts from the start."""
        return self.counts.get(column, 0.0)

    @property
    def steps(self) -> int:
        """Steps of all legs."""
        return sum(steps for _, steps in self.legs)

    def after(
        self, case: Case, steps: int, curve: dict[str, Any], counts: Mapping[str, float], drive: npt.NDArray[np.float64]
    ) -> Past:
        """The past with one more leg: its case, its steps, the columns of its series, its counts, and the path of its drive."""
        return Past(
            (*self.legs, (case, steps)),
            (*self.curves, (curve, self._before())),
            {column: self.counted(column) + count for column, count in counts.items()},
            self.origin + drive,
        )

    def joined(self, curve: dict[str, Any]) -> dict[str, Any]:
        """The curve of all legs and of this one, with counts that continue."""
        if not self.legs:
            return curve
        curves = [*self.curves, (curve, self._before())]
        columns = dict.fromkeys(column for own, _ in curves for column in own)
        return {column: np.concatenate([self._column(column, *parts) for parts in curves]) for column in columns}

    def _before(self) -> Mapping[str, float]:
        return {"step": self.steps, **self.counts}

    def _column(self, column: str, own: Mapping[str, Any], before: Mapping[str, float]) -> npt.NDArray[Any]:
        """A column of a leg, with counts that continue those before it; NaN if the leg lacks it and it is not a count."""
        if column in own:
            values = own[column]
        elif column == "drive_time_star":
            # For a drive that is not held, it is the time itself.
            values = own["time_star"]
        else:
            values = np.full(len(own["step"]), 0.0 if column in self.counts else np.nan)
        return np.asarray(values + before.get(column, 0))
