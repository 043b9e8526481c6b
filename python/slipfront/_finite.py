"""Checks of the numbers in arrays of the user."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def check_numbers(name: str, values: npt.ArrayLike, *, may_be_infinite: bool = False) -> None:
    """Refuse an array with a value that is NaN or infinite, and report its index.

    >>> check_numbers("mask", [[0, 1], [float("nan"), 1]])
    Traceback (most recent call last):
        ...
    ValueError: `mask[1, 0]` is NaN, where a number is wanted: correct this value
    """
    array = np.asarray(values)
    if array.dtype.kind != "f":
        return
    wrong = np.isnan(array) if may_be_infinite else ~np.isfinite(array)
    if wrong.any():
        place = tuple(int(index) for index in np.argwhere(wrong)[0])
        found = "NaN" if np.isnan(array[place]) else f"{array[place]}"
        raise ValueError(f"`{name}[{', '.join(map(str, place))}]` is {found}, where a number is wanted: correct this value")
