"""Pictures and numbers in notebooks."""

from __future__ import annotations

import base64
import html
import math
import struct
import zlib
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

_MAX_PIXELS = 400
_MAX_ROWS = 20


def numbers(rows: Iterable[tuple[str, str]]) -> str:
    """A table of two columns: names and values."""
    cells = (
        f'<tr><td style="text-align:left"><b>{html.escape(name)}</b></td>'
        f'<td style="text-align:left">{html.escape(value)}</td></tr>'
        for name, value in rows
    )
    return f"<table>{''.join(cells)}</table>"


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table with a header; of many rows, only the first."""
    shown = rows[:_MAX_ROWS]
    if len(rows) > len(shown):
        shown = [*shown, [f"{len(rows) - len(shown)} more", *[""] * (len(header) - 1)]]

    def line(cells: Sequence[str], kind: str) -> str:
        return f"<tr>{''.join(f'<{kind}>{html.escape(cell)}</{kind}>' for cell in cells)}</tr>"

    return f"<table>{line(header, 'th')}{''.join(line(cells, 'td') for cells in shown)}</table>"


def with_error(value: float, error: float | None) -> str:
    """A number and its uncertainty, if it has one."""
    return f"{value:.4g}" + ("" if error is None or math.isnan(error) else f" \u00b1 {error:.2g}")


def picture(textured: npt.NDArray[np.bool_]) -> str:
    """A texture, dark, seen from above with y upwards; of a large one, every n-th block."""
    stride = -(-max(textured.shape) // _MAX_PIXELS)
    grey = np.where(textured[::-stride, ::stride], 60, 225).astype(np.uint8)
    data = base64.b64encode(_png(grey)).decode("ascii")
    rows, columns = textured.shape
    return (
        f'<div><img alt="texture of {columns} x {rows} blocks" src="data:image/png;base64,{data}" '
        'style="width:160px;image-rendering:pixelated;border:1px solid #888"></div>'
    )


def _png(grey: npt.NDArray[np.uint8]) -> bytes:
    """A PNG image of 8-bit grey values."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        checked = kind + data
        return struct.pack(">I", len(data)) + checked + struct.pack(">I", zlib.crc32(checked))

    rows, columns = grey.shape
    # Each row begins with the number of its filter, 0 for none.
    filtered: npt.NDArray[Any] = np.hstack([np.zeros((rows, 1), np.uint8), grey])
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(filtered.tobytes())) + chunk(b"IEND", b"")
