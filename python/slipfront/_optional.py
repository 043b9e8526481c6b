"""Packages that are used if they are installed."""

from __future__ import annotations

import importlib
from typing import Any


def needed(package: str, whom: str) -> Any:
    """A package that something needs."""
    try:
        return importlib.import_module(package)
    except ImportError as missing:
        raise ImportError(f"{whom} needs {package.partition('.')[0]}, which is not installed: {_remedy(package)}") from missing


class Columns(dict[str, Any]):
    """Columns by name, instead of a table of pandas or a dataset of xarray, if that is not installed."""

    package = "xarray"

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(
            f"this is a dictionary of arrays without `{name}`, since {self.package} is not installed: {_remedy(self.package)}"
        )

    def copy(self) -> Columns:
        return type(self)(self)


class PandasColumns(Columns):
    """Columns instead of a table of pandas."""

    package = "pandas"


def _remedy(package: str) -> str:
    return f"`pip install {package.partition('.')[0]}`"
