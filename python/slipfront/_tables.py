"""Tables in folders of results."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ._optional import PandasColumns

if TYPE_CHECKING:
    import pandas as pd


def read_table(path: Path) -> dict[str, list[Any]]:
    """The columns of a table: numbers if all cells are numbers or empty (NaN)."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns: dict[str, list[Any]] = {}
    for position, name in enumerate(rows[0]):
        cells = [row[position] for row in rows[1:]]
        try:
            columns[name] = [float(cell) if cell else np.nan for cell in cells]
        except ValueError:
            columns[name] = cells
            continue
        if all(cell.isdigit() for cell in cells):
            columns[name] = [int(cell) for cell in cells]
    return columns


def frame(table: dict[str, list[Any]]) -> pd.DataFrame:
    """A table of pandas, or if that is not installed, a dictionary of arrays."""
    try:
        import pandas
    except ImportError:
        return cast("pd.DataFrame", PandasColumns({name: np.asarray(values) for name, values in table.items()}))
    return pandas.DataFrame(table)
