"""Studies, designs and calibrations: a file, or a case and further tables."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol, TypeVar

import slipfront._toml as _toml
from ._case import Case, CaseLike, Overrides, as_case, set_anew
from ._temporary import TemporaryFolder

Native = TypeVar("Native", covariant=True)


class Kind(Protocol[Native]):
    """A kind of project, as the native part makes it."""

    @staticmethod
    def load(path: Path, overrides: list[str]) -> Native: ...
    @staticmethod
    def parse(text: str, name: str, folder: Path) -> Native: ...


def of_file(kind: Kind[Native], path: str | os.PathLike[str], overrides: Overrides | None) -> tuple[Native, TemporaryFolder | None]:
    """The project of a file, with other values of some keys of its case, and the folder of their arrays."""
    arrays = _toml.Arrays()
    # A value never has a line break.
    text, folder = arrays.on_disk("\n".join(set_anew(overrides, arrays)))
    return kind.load(Path(path), text.splitlines()), folder


def of_case(
    kind: Kind[Native],
    case: CaseLike,
    overrides: Overrides | None,
    tables: Mapping[str, Mapping[str, Any]],
    name: str | None,
    ending: str,
    further: Callable[[_toml.Arrays], str] = lambda _: "",
) -> tuple[Native, TemporaryFolder | None]:
    """The project of a case and of tables, with the name `name` or that of its case and an ending; and the folder of arrays."""
    case = as_case(case, overrides)
    arrays = _toml.Arrays(case._native.arrays)
    text = _toml.document(tables, arrays) + further(arrays) + _as_base(case)
    # Runs read arrays from files, which exist as long as there may be runs.
    text, folder = arrays.on_disk(text)
    return kind.parse(text, name or f"{case.name}-{ending}", Path()), folder


def _as_base(case: Case) -> str:
    """The tables of a case as the base of a project, with the paths of files."""
    lines = []
    for line in case._text().splitlines():
        if line.startswith("[["):
            line = "[[base." + line[2:]
        elif line.startswith("["):
            line = "[base." + line[1:]
        lines.append(line)
    return "\n".join(["[base]", *lines, ""])
