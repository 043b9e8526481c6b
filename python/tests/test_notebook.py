"""Results as notebooks show them, as datasets, and where a package is not installed."""

import re
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import slipfront as sf

SLIDER: dict[str, Any] = {"slider": {"blocks": [8, 8]}, "drive": {"v_star": 0.1}, "time": {"stop": "after_onset"}}


def cells(shown: str) -> list[list[str]]:
    """The rows of a table in HTML."""
    rows = re.findall("<tr>(.*?)</tr>", shown)
    return [re.findall("<t[hd][^>]*>(?:<b>)?(.*?)(?:</b>)?</t[hd]>", row) for row in rows]


def test_a_study_shows_the_means_of_its_points() -> None:
    axes: dict[str, Any] = {"drive.v_star": [0.05, 0.1], "shape": {"plain": {}, "<": {"friction.seed": 9}}}
    results = sf.Study(SLIDER, axes=axes, replicates=3).run(progress=False)
    shown = results._repr_html_()
    header, *rows = cells(shown)
    assert "<b>12 runs, 0 failed</b>" in shown and header == ["drive speed V*", "shape", "static friction \u03bc\u209b*"]
    assert [row[:2] for row in rows] == [["0.05", "plain"], ["0.05", "&lt;"], ["0.1", "plain"], ["0.1", "&lt;"]]
    means = results.points.query("quantity == 'static_friction_star'")
    assert [row[2].partition(" \u00b1 ")[0] for row in rows] == [f"{mean:.4g}" for mean in means["mean"]]
    many = sf.Study(SLIDER, axes={"friction.seed": list(range(30))}).run(progress=False)
    assert cells(many._repr_html_())[-1] == ["10 more", ""]


def test_meshes_designs_and_calibrations_are_tables() -> None:
    meshes = sf.converge(SLIDER, replicates=1, progress=False)
    header, *rows = cells(meshes._repr_html_())
    assert header == ["blocks of", *meshes.block_sizes, "mesh error"]
    assert [row[1:-1] for row in rows] == [[f"{value:.4g}" for value in found.values] for found in meshes.quantities.values()]
    found = sf.Design(SLIDER, wish=sf.Value(0.5), coverage=(0, 40), tolerance=0.1, feature_blocks=2, runs=10).run(progress=False)
    shown = found._repr_html_()
    assert "<img" in shown and ["A*", f"{found.coverage:.4g} %"] in cells(shown)
    assert found.within_tolerance is not None and ["within the tolerance", "{} of {}".format(*found.within_tolerance)] in cells(shown)
    rig = {"slider": {"blocks": [6, 6]}, "drive": {"v_star": 0.1}, "time": {"step": 0.4}}
    series = sf.run(rig, {"output.series": 1}, progress=False).series
    unknowns: dict[str, Any] = {"drive.stiffness_star": (0.3, 0.9), "slider.density": ("9000 kg/m^3", "11000 kg/m^3")}
    calibration = sf.Calibration(rig, unknowns=unknowns, noise=0.01, runs=200, finer_runs=0)
    with pytest.warns(UserWarning):
        fit = calibration.fit((series["time_s"], 5 * series["friction_force_n"]), progress=False)
    header, *rows = cells(fit._repr_html_())
    assert header == ["key", "median", "90 % interval", ""] and [row[0] for row in rows] == list(unknowns)
    assert rows[1][1].endswith(" kg/m^3") and "cannot reproduce these records" in fit._repr_html_()


def test_a_study_is_a_dataset() -> None:
    axes: dict[str, Any] = {"texture.0.coverage": [5, 20], "load.pressure": ["50 kPa", "1 MPa"]}
    study = sf.Study(SLIDER, {"texture": [{"shape": "groove", "coverage": 5}]}, axes=axes, replicates=2, reference={"texture": []})
    results = study.run(progress=False, quantities={"twice": lambda run: 2 * run.steps})
    found = results.to_xarray()
    assert dict(found.sizes) == {"texture.0.coverage": 2, "load.pressure": 2, "replicate": 2}
    assert found["load.pressure"].values.tolist() == [50, 1000] and found["load.pressure"].attrs == {"long_name": "pressure P (kPa)"}
    for _, row in results.runs.query("role == 'point'").iterrows():
        pressure = 50 if row["load.pressure"] == "50 kPa" else 1000
        run = found.sel({"texture.0.coverage": row["texture.0.coverage"], "load.pressure": pressure, "replicate": row["replicate"]})
        for name in ("static_friction_star", "static_reduction_percent", "twice"):
            assert float(run[name]) == row[name]
    means = results.points.query("quantity == 'static_friction_star'")["mean"].to_numpy()
    # Two ways to add two numbers.
    np.testing.assert_allclose(found["static_friction_star"].mean("replicate").values.ravel(), means, rtol=1e-14)
    assert found["static_friction_star"].attrs == {"long_name": "static friction \u03bc\u209b*"}


def test_an_axis_of_several_keys_is_one_dimension() -> None:
    found = sf.converge(SLIDER, replicates=1, progress=False).to_xarray()
    assert dict(found.sizes) == {"slider.block_size": 3, "replicate": 1}
    assert found["slider.blocks"].dims == ("slider.block_size",)
    named = sf.Study(SLIDER, axes={"shape": {"plain": {}, "fast": {"drive.v_star": 0.2}}}).run(progress=False).to_xarray()
    assert named["shape"].values.tolist() == ["plain", "fast"] and named["v_star"].values.ravel().tolist() == [0.1, 0.2]


def test_a_package_that_is_missing_is_named_with_the_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    results = sf.Study(SLIDER, axes={"friction.seed": [1, 2]}).run(progress=False)
    run = sf.run(SLIDER, progress=False)
    for package in ("pandas", "xarray", "matplotlib", "matplotlib.pyplot"):
        monkeypatch.setitem(sys.modules, package, None)
    # What there is without them is a dictionary.
    assert len(results.points["mean"]) == len(results.points["quantity"]) and run.series["mu_star"].max() == run.static_friction_star
    uses: dict[str, Callable[[], object]] = {"pandas": lambda: results.points.query("n > 1"), "xarray": lambda: run.series.sel(time_star=0)}
    for package, use in uses.items():
        told = f"a dictionary of arrays without `.*`, since {package} is not installed: `pip install {package}`"
        with pytest.raises(AttributeError, match=told):
            use()
    with pytest.raises(ImportError, match="`to_xarray` needs xarray, which is not installed: `pip install xarray`"):
        results.to_xarray()
    with pytest.raises(ImportError, match="a picture needs matplotlib, which is not installed: `pip install matplotlib`"):
        run.plot()
