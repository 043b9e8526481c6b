"""Pictures of the module have the labels of those of the command."""

import re
import unicodedata
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipfront as sf

from .test_command import command

pytest.importorskip("matplotlib").use("agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402


def texts_of(picture: Path) -> str:
    """All texts of a picture of the command; a subscript is one of its own."""
    return plain("".join(re.findall("<text[^>]*>(.*?)</text>", picture.read_text(encoding="utf-8"))))


def plain(text: str) -> str:
    """A text without subscripts, neither those of the command nor of matplotlib."""
    return unicodedata.normalize("NFKC", re.sub(r"\$_\{\\mathrm\{(.)\}\}\$", r"\1", text))


def labels_of(ax: Axes) -> list[str]:
    """The labels of a picture of the module, those of its colour bar and its legend included."""
    figure = ax.get_figure()
    assert figure is not None
    found = [label for drawn in figure.axes for label in (drawn.get_xlabel(), drawn.get_ylabel()) if label]
    legend = ax.get_legend()
    found += [] if legend is None else [text.get_text() for text in (legend.get_title(), *legend.get_texts())]
    plt.close("all")
    return [plain(label) for label in found]


@pytest.mark.parametrize("more", [{}, {"drive.motion": "rotation", "load.pressure": "1 kPa"}])
def test_a_run(more: dict[str, Any], tmp_path: Path) -> None:
    fields = ["contact_stress_star", "traction", "displacement_x", "velocity_y", "sliding"]
    run = sf.run("cases/circle.toml", {"output.fields": fields, **more}, progress=False)
    folder = run.save(tmp_path / "run")
    drawn = texts_of(folder / "friction.svg") + texts_of(folder / "front.svg")
    for kind in ("friction", "front", "kymograph"):
        assert all(label in drawn for label in labels_of(run.plot(kind))), kind
    for field in fields:
        plotted = command("plot", folder, "--field", field, "-o", tmp_path / "maps")
        assert plotted.returncode == 0, plotted.stderr
        found, drawn = labels_of(run.plot(field, instant=0)), texts_of(tmp_path / "maps" / f"{field}.svg")
        assert len(found) == 3 and all(label in drawn for label in found), field


def test_a_study(tmp_path: Path) -> None:
    base = {"slider": {"blocks": [20, 20]}, "time": {"stop": "after_onset"}, "texture": [{"shape": "groove", "coverage": 5}]}
    axes: dict[str, Any] = {"texture.0.coverage": [5, 12], "load.pressure": ["0.05 MPa", "0.1 MPa", "1 MPa"]}
    results = sf.Study(base, axes=axes, replicates=2).run(tmp_path / "study", progress=False)
    # Curves over coverage, and a map over both.
    curves, both = (texts_of(tmp_path / "study" / f"static_friction_star{ending}.svg") for ending in ("", "_map"))
    assert all(label in curves for label in labels_of(results.plot()))
    assert all(label in both for label in labels_of(results.plot(over="load.pressure"))[:2])
    assert labels_of(results.plot())[0] == "meshed texture coverage A* (%)"
    opened = sf.open_study(tmp_path / "study")
    line = opened.plot(over="load.pressure").lines[0]
    assert np.array_equal(np.asarray(line.get_xdata()), [0.05, 0.1, 1])
    assert opened.to_xarray()["texture.0.coverage"].attrs == {"long_name": "texture coverage A* (%)"}
