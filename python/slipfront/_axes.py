"""Axes of a study: the levels of its points, and their labels in pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from ._html import with_error
from ._optional import needed
from ._slipfront import title

if TYPE_CHECKING:
    import xarray as xr


class Axis(TypedDict):
    """An axis, as reported by the native part."""

    columns: list[str]
    title: str
    drawn_title: str
    drawn_symbol: str
    """Titles as in pictures, which show meshed coverages instead of levels if `is_meshed`."""
    is_meshed: bool
    is_log: bool
    levels: list[tuple[list[str], float | None, str, str]]
    """The cells of each level in the columns, its number if any, its name, and its name next to those of other axes."""


def levels_of(point: int, axes: Sequence[Axis]) -> tuple[int, ...]:
    """The levels of a point; the last axis varies fastest."""
    return tuple(int(level) for level in np.unravel_index(point, [len(axis["levels"]) for axis in axes]))


def grid(runs: dict[str, list[Any]], axes: Sequence[Axis]) -> xr.Dataset:
    """The numbers of the runs of points over the axes and the replicates."""
    xarray = needed("xarray", "`to_xarray`")
    kept = [row for row, role in enumerate(runs["role"]) if role == "point"]
    replicates = 1 + max((runs["replicate"][row] for row in kept), default=0)
    shape = [*(len(axis["levels"]) for axis in axes), replicates]
    places = [(*levels_of(runs["point"][row], axes), runs["replicate"][row]) for row in kept]
    dimensions = [*(axis["columns"][0] for axis in axes), "replicate"]

    def over_axes(name: str) -> tuple[list[str], Any, dict[str, str]]:
        values = np.full(shape, np.nan)
        for place, row in zip(places, kept, strict=True):
            values[place] = runs[name][row]
        return dimensions, values, {"long_name": title(name)}

    names = list(runs)
    numbers = names[names.index("reason") + 1 :]
    coordinates: dict[str, Any] = {"replicate": np.arange(replicates)}
    for axis in axes:
        for place, column in enumerate(axis["columns"]):
            cells = [level[0][place] for level in axis["levels"]]
            values = [level[1] for level in axis["levels"]] if len(axis["columns"]) == 1 else cells
            label = {"long_name": axis["title"]} if place == 0 else {}
            coordinates[column] = axis["columns"][0], cells if None in values else values, label
    found: xr.Dataset = xarray.Dataset({name: over_axes(name) for name in numbers}, coordinates)
    return found


_MAIN = ("static_friction_star", "kinetic_friction_star", "static_reduction_percent")


def means_by_point(points: dict[str, list[Any]], axes: Sequence[Axis]) -> tuple[list[str], list[list[str]]]:
    """A table of the means of the main quantities: its header, and a row for each point."""
    means: dict[int, dict[str, str]] = {}
    for point, quantity, mean, low, high in zip(*(points[name] for name in ("point", "quantity", "mean", "low", "high")), strict=True):
        cells = means.setdefault(point, {})
        if quantity in _MAIN and not np.isnan(mean):
            cells[quantity] = with_error(mean, 0.5 * (high - low))
    shown = [quantity for quantity in _MAIN if any(quantity in cells for cells in means.values())]

    def row(point: int, cells: dict[str, str]) -> list[str]:
        levels = zip(axes, levels_of(point, axes), strict=True)
        return [*(axis["levels"][level][2] for axis, level in levels), *(cells.get(quantity, "") for quantity in shown)]

    header = [*(axis["title"] for axis in axes), *map(title, shown)]
    return header, [row(point, cells) for point, cells in means.items()]
