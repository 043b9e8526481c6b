"""Reads drawings of textures with ezdxf and compares them with fields of the same cases; run.sh calls it.

    check.py FOLDER
"""

import sys
from pathlib import Path

import ezdxf
import numpy as np
from ezdxf.path import make_path
from matplotlib.path import Path as Outline


def field(path):
    """The length of a block in millimetres, and whether each block is textured, upwards from the lowest row."""
    header, numbers = path.read_bytes().split(b"\0", 1)
    keys = dict(line.split(" = ") for line in header.decode().splitlines()[1:])
    nx, ny = int(keys["XRes"]), int(keys["YRes"])
    heights = np.frombuffer(numbers[-4 * nx * ny :], "<f4").reshape(ny, nx)
    return 1e3 * float(keys["XReal"]) / nx, heights[::-1] == 0


def corners(entity):
    """The corners of an outline, each of whose arcs becomes 256 straight lines."""
    kind = entity.dxftype()
    assert kind in ("CIRCLE", "ELLIPSE") or (kind == "LWPOLYLINE" and entity.closed), f"{kind} is not closed"
    x, y = np.array([[point.x, point.y] for point in make_path(entity).flattening(1, 256)]).T
    assert np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) != 0, f"{kind} is empty"
    return np.stack([x, y], -1)


def check(path):
    """Checks one drawing against the field beside it."""
    drawing = ezdxf.readfile(path)
    audit = drawing.audit()
    assert not audit.errors and not audit.fixes, audit.errors + audit.fixes
    block, textured = field(path.with_suffix(".gsf"))
    # Centres of blocks, somewhat aside: of a groove the lower edge is in, and the upper one out.
    y, x = np.indices(textured.shape).reshape(2, -1) + 0.5 + 1e-6
    filled = {}
    for entity in drawing.modelspace():
        layer = entity.dxf.layer
        inside = Outline(corners(entity) / block).contains_points(np.stack([x, y], -1))
        others = filled.get(layer, np.zeros_like(inside))
        # Programs for lasers leave out what lies in two outlines of a layer.
        filled[layer] = others ^ inside
    assert filled.pop("SLIDER").any(), "there is no slider"
    any_filled = np.any([np.zeros(textured.size, bool), *filled.values()], axis=0)
    wrong = np.sum(any_filled != textured.ravel())
    assert wrong == 0, f"{wrong} blocks are filled otherwise than they are textured"


drawings = sorted(Path(sys.argv[1]).glob("*.dxf"))
for drawing in drawings:
    try:
        check(drawing)
    except AssertionError as error:
        sys.exit(f"{drawing.name}: {error}")
print(f"{len(drawings)} drawings are valid and fill the textured blocks")
