"""Pictures of runs by matplotlib, in journal sizes."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from ._axes import Axis, levels_of
from ._case import Case
from ._optional import needed
from ._slipfront import title, title_of_field, titles_of_run

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

_WIDTH = 85 / 25.4
_STYLE = {
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.0,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
}


class Drawn(Protocol):
    """Parts of a run that are drawn."""

    @property
    def case(self) -> Case: ...
    @property
    def summary(self) -> dict[str, Any]: ...
    @property
    def series(self) -> xr.Dataset: ...
    @property
    def kymograph(self) -> xr.Dataset | None: ...
    @property
    def _arrays(self) -> dict[str, Any]: ...


def plot(run: Drawn, kind: str, ax: Axes | None, instant: str | int, label: str | None) -> Axes:
    """Draw a run, as described at `Run.plot`."""
    if kind == "friction":
        return drawn(partial(_friction, run, label), 0.75, ax)
    if kind == "kymograph":
        return drawn(partial(_kymograph, run), 0.75, ax)
    if kind == "front":
        values, label = run._arrays["first_slip_time_star"], _titles(run)["first_slip_time_star"]
    else:
        values, label = _field(run, kind, instant)
    height = min(max(0.85 * values.shape[0] / values.shape[1], 0.3), 1.5)
    return drawn(partial(_map, run, values, label), height, ax)


def _titles(run: Drawn) -> dict[str, str]:
    """Titles of the axes of pictures of a run."""
    titles = titles_of_run(run.summary.get("motion") == "rotation")
    return {name: _with_subscripts(title) for name, title in titles}


def _with_subscripts(title: str) -> str:
    """A title for matplotlib, in which the character after an underscore is a subscript."""
    return re.sub("_(.)", r"$_{\\mathrm{\1}}$", title)


def drawn(draw: Callable[[Axes], None], height: float, ax: Axes | None) -> Axes:
    """Draw in these axes, or in new ones as wide as a journal column, with this ratio of height to width."""
    plt = needed("matplotlib.pyplot", "a picture")
    if ax is not None:
        draw(ax)
        return ax
    # The first figure chooses the backend; within the style it would be lost.
    figure = plt.figure(figsize=(_WIDTH, height * _WIDTH), layout="compressed")
    with plt.rc_context(cast("Any", _STYLE)):
        new: Axes = figure.add_subplot()
        draw(new)
    return new


def _friction(run: Drawn, label: str | None, ax: Axes) -> None:
    series = run.series
    time_star, mu_star = np.asarray(series["time_star"]), np.asarray(series["mu_star"])
    (line,) = ax.plot(time_star, mu_star, label=label or run.case.name)
    for found in run.summary["instants"]:
        ax.plot(found["time_star"], found["mu_star"], ".", ms=4, color=line.get_color())
        # Next to the curve, which rises before the peak and falls after it.
        ax.annotate(found["instant"], (found["time_star"], found["mu_star"]), (3, 2), textcoords="offset points", fontsize=7)
    titles = _titles(run)
    ax.set_xlabel(titles["time_star"])
    ax.set_ylabel(titles["mu_star"])
    ax.set_ylim(bottom=0)
    ax.set_xlim(left=0)
    if label is not None:
        ax.legend(frameon=False)


def _kymograph(run: Drawn, ax: Axes) -> None:
    kymograph = run.kymograph
    if kymograph is None:
        raise ValueError("the folder of the run is of a version that kept no kymograph: run its case again")
    time_star, place = np.asarray(kymograph["time_star"]), np.asarray(kymograph["place"])
    unit, prefix = _unit(float(place[-1]))
    # Each value represents the time and the place around it.
    (first, last), (start, end) = _ends(time_star), _ends(place)
    extent = (first, last, start / unit, end / unit)
    share, titles = np.asarray(kymograph["sliding_share"]).T, _titles(run)
    image = ax.imshow(share, origin="lower", extent=extent, aspect="auto", cmap="viridis", vmin=0, interpolation="nearest")
    ax.set_xlabel(titles["time_star"])
    ax.set_ylabel(f"{titles['place']} ({prefix}m)")
    _colorbar(ax, image, titles["sliding_share"])


def _ends(centres: npt.NDArray[np.float64]) -> tuple[float, float]:
    """Ends of equal intervals around these centres."""
    half = 0.5 * (centres[-1] - centres[0]) / max(len(centres) - 1, 1)
    return float(centres[0] - half), float(centres[-1] + half)


def _colorbar(ax: Axes, image: AxesImage, title: str) -> None:
    cast("Figure", ax.get_figure(root=True)).colorbar(image, ax=ax, label=title, fraction=0.046, pad=0.03)


def _map(run: Drawn, values: npt.NDArray[Any], title: str, ax: Axes) -> None:
    x, y = (run._arrays[axis] for axis in ("x", "y"))
    half = 0.5 * run.case.numbers["block_size_m"] * run._arrays["stride"]
    unit, prefix = _unit(float(x[-1] + half))
    extent = (0.0, (x[-1] + half) / unit, 0.0, (y[-1] + half) / unit)
    image = ax.imshow(values, origin="lower", extent=extent, cmap="viridis", interpolation="nearest")
    # Blocks without a value show the background; a texture with values gets an outline along the edges of its blocks.
    ax.set_facecolor("0.8")
    textured = run._arrays["textured"]
    if np.isfinite(values[textured]).any():
        per_block = max(1, min(8, 4000 // max(values.shape)))
        fine = np.kron(textured, np.ones((per_block, per_block)))
        across, along = (np.linspace(0, end, 2 * n + 1)[1::2] for end, n in zip(extent[1::2], fine.shape[::-1], strict=True))
        ax.contour(across, along, fine, levels=[0.5], colors="white", linewidths=0.8)
    ax.set_xlabel(f"x ({prefix}m)")
    ax.set_ylabel(f"y ({prefix}m)")
    _colorbar(ax, image, title)


def _field(run: Drawn, name: str, instant: str | int) -> tuple[npt.NDArray[Any], str]:
    arrays = run._arrays["fields"]
    if name not in arrays:
        kept = ", ".join(f'"{kept}"' for kept in arrays) or "none"
        raise ValueError(f'the run has no field "{name}"; pictures are "friction", "front", "kymograph", and its fields: {kept}')
    letters = list(run._arrays["instants"]["instant"])
    if isinstance(instant, str):
        found = [position for position, shown in enumerate(letters) if instant in shown]
        if not found:
            raise ValueError(f'the run has no instant "{instant}": it has {", ".join(letters) or "none"}')
        instant = found[0]
    values, _, _ = arrays[name]
    # The unit of all snapshots.
    label, unit = title_of_field(run.case._native, name, values.reshape(-1, values.shape[-1]))
    return values[instant] / unit, _with_subscripts(label)


def plot_points(
    points: dict[str, list[Any]], axes: Sequence[Axis], quantity: str, ax: Axes | None, over: str | None
) -> Axes:
    """Draw the means of a quantity over an axis of a study, as described at `StudyResults.plot`."""
    rows = [dict(zip(points, cells, strict=True)) for cells in zip(*points.values(), strict=True)]
    found = [row for row in rows if row["quantity"] == quantity]
    if not found:
        known = ", ".join(dict.fromkeys(f'"{row["quantity"]}"' for row in rows))
        raise ValueError(f'the study has no quantity "{quantity}": it has {known}')
    if not axes:
        raise ValueError("a study without an axis has one point: `points` has its mean")
    columns = {column: place for place, axis in enumerate(axes) for column in axis["columns"]}
    if over is not None and over not in columns:
        raise ValueError(f'the study has no axis "{over}": it has {", ".join(columns)}')
    along = 0 if over is None else columns[over]
    curves: dict[tuple[int, ...], list[Point]] = {}
    for row in found:
        levels = levels_of(row["point"], axes)
        curves.setdefault((*levels[:along], *levels[along + 1 :]), []).append((levels[along], row))
    others = [*axes[:along], *axes[along + 1 :]]
    labelled = [(_curve_label(others, levels, own), own) for levels, own in curves.items()]
    legend = others[0]["drawn_symbol"] if len(others) == 1 else None
    return drawn(partial(_points, labelled, axes[along], quantity, legend), 0.75, ax)


Point: TypeAlias = tuple[int, dict[str, Any]]
"""The level of a point on the drawn axis, and its row."""


def _curve_label(others: Sequence[Axis], levels: Sequence[int], points: Sequence[Point]) -> str:
    """Name of a curve by its levels of the other axes; the level alone if there is one axis, since the legend has its title."""
    names = [axis["levels"][level] for axis, level in zip(others, levels, strict=True)]
    if len(others) != 1:
        return ", ".join(beside for *_, beside in names)
    if not others[0]["is_meshed"]:
        return names[0][2]
    ends = dict.fromkeys(f"{of(row['texture_percent'] for _, row in points):.4g}" for of in (min, max))
    return " to ".join(ends)


def _points(curves: Sequence[tuple[str, list[Point]]], axis: Axis, quantity: str, legend: str | None, ax: Axes) -> None:
    numbers = [number for _, number, *_ in axis["levels"]]
    is_of_numbers = None not in numbers

    def x(level: int, row: dict[str, Any]) -> Any:
        name = axis["levels"][level][2]
        return row["texture_percent"] if axis["is_meshed"] else numbers[level] if is_of_numbers else name

    for label, points in curves:
        rows = [(x(*point), point[1]) for point in points]
        if is_of_numbers:
            rows.sort(key=itemgetter(0))
        mean, low, high = (np.array([row[column] for _, row in rows], dtype=float) for column in ("mean", "low", "high"))
        # One run has no interval.
        errors = np.nan_to_num([mean - low, high - mean])
        ax.errorbar([place for place, _ in rows], mean, errors, marker="o", ms=3, capsize=2, label=label)
    # A texture that covers no block has no place on a logarithmic scale.
    if axis["is_log"] and all(x(*point) > 0 for _, points in curves for point in points):
        ax.set_xscale("log")
    ax.set_xlabel(axis["drawn_title"])
    ax.set_ylabel(title(quantity))
    if len(curves) > 1:
        ax.legend(title=legend, frameon=False)


def plot_band(band: dict[str, list[Any]], ax: Axes | None) -> Axes:
    """Draw a record over the band of a calibrated model, as described at `CalibrationResults.plot`."""
    return drawn(partial(_band, band), 0.75, ax)


def _band(band: dict[str, list[Any]], ax: Axes) -> None:
    titles = list(band)
    x, record, low, median, high = (np.asarray(column, dtype=float) for column in band.values())
    (along, x_title), (up, y_title) = _in_unit(titles[0], x), _in_unit(titles[1], high)
    ax.fill_between(x / along, low / up, high / up, alpha=0.3, linewidth=0)
    ax.plot(x / along, median / up, label="model, median and 90 %")
    ax.plot(x / along, record / up, label="record")
    ax.set_xlabel(x_title)
    ax.set_ylabel(y_title)
    ax.legend(frameon=False)


def _in_unit(title: str, values: npt.NDArray[np.float64]) -> tuple[float, str]:
    """The unit that suits the values of a column, and its title with that unit."""
    name, bracket, unit = title.partition(" (")
    size, prefix = _unit(float(np.nanmax(np.abs(values), initial=0.0))) if bracket else (1.0, "")
    return size, f"{name}{bracket}{prefix}{unit}"


def _unit(largest: float) -> tuple[float, str]:
    """The power of a thousand that suits a number, and its prefix."""
    prefixes = ("f", "p", "n", "\u00b5", "m", "", "k", "M", "G")
    if not largest > 0:
        return 1.0, ""
    power = int(np.clip(np.floor(np.log10(largest) / 3), -5, 3))
    return 1000.0**power, prefixes[power + 5]
