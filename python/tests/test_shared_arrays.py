"""Results that are handed out cannot spoil later ones: arrays that are shared cannot be written to, and all else is a copy."""

import contextlib
import functools
import pickle
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipfront as sf

xarray = pytest.importorskip("xarray")
pandas = pytest.importorskip("pandas")

# Words that stand for the arguments of methods that hand something out. Other methods take steps, write files
# or draw.
METHODS: dict[str, list[tuple[Any, ...]]] = {
    "field": [("traction",), ("sliding",), ("contact_stress_star",), ("displacement_x",), ("velocity_y",)],
    "recipe": [()],
    "checkpoint": [()],
    "to_dict": [()],
    "to_list": [()],
    "to_toml": [()],
}
# Blocks of twice the size divide it too.
SLIDER_ON_MESHES = {"slider": {"blocks": [12, 10]}, "drive": {"v_star": 0.1}, "time": {"stop": "after_onset"}}
OURS = (sf.Case, sf.Run, sf.Simulation, sf.StudyResults, sf.PaperResults, sf.InterruptedRun)


def handed_out(holder: object) -> Iterator[tuple[str, Any]]:
    """All that a public attribute or method of an object gives, under its name."""
    for name in dir(holder):
        if name.startswith("_"):
            continue
        if isinstance(getattr(type(holder), name, None), (property, functools.cached_property)) or name in vars(holder):
            yield name, getattr(holder, name)
        for arguments in METHODS.get(name, []):
            yield f"{name}{arguments}", getattr(holder, name)(*arguments)


def content(value: Any) -> Any:
    """The content of a value, to the bit."""
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tolist() if value.dtype == object else value.tobytes()
    if isinstance(value, xarray.Dataset):
        attributes = {name: dict(value[name].attrs) for name in value.variables}
        return repr(value.attrs), attributes, {name: content(value[name].values) for name in value.variables}
    if isinstance(value, pandas.DataFrame):
        return {name: content(value[name].to_numpy()) for name in value}
    if isinstance(value, dict):
        return {name: content(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [content(inner) for inner in value]
    # Of an object of slipfront what it hands out is looked at by itself.
    return type(value) if isinstance(value, OURS) else repr(value)


def spoil(value: Any) -> int:
    """Changes all of a value that can be changed; the number of arrays that it met."""
    met = 0
    if isinstance(value, np.ndarray):
        if value.flags.writeable and value.size:
            value.ravel()[0] = value.flat[-1]
            value[...] = "?" if value.dtype.kind in "UO" else 1 - value.flat[0]
        return 1
    if isinstance(value, xarray.Dataset):
        for name in value.variables:
            array = value[name]
            met += spoil(array.values) + spoil(array.data) + spoil(array.variable.to_base_variable().values)
            array.attrs.clear()
            with contextlib.suppress(ValueError, TypeError):
                value[name] *= 2
        met += sum(spoil(index.values) for index in value.indexes.values())
        value.attrs["spoilt"] = True
        for name in list(value.data_vars):
            del value[name]
    elif isinstance(value, pandas.DataFrame):
        met += sum(spoil(value[name].to_numpy()) for name in value) + spoil(value.values)
        for name in list(value):
            del value[name]
    elif isinstance(value, (dict, list)):
        met += sum(spoil(inner) for inner in (value.values() if isinstance(value, dict) else value))
        value.clear()
    elif isinstance(value, tuple):
        met += sum(spoil(inner) for inner in value)
    return met


def holders(folder: Path) -> dict[str, object]:
    """Everything that hands out arrays, new and from folders and pickles."""
    mask = np.zeros((10, 12), dtype=bool)
    mask[2:4, 3:6] = True
    output = {"fields": ["traction", "displacement_x", "sliding"]}
    tables = {"slider": {"blocks": [12, 10]}, "texture": [{"shape": "mask", "file": mask}], "output": output}
    case = sf.Case({**tables, "time": {"duration_star": 100}})
    edge = sf.Case.load("cases/edge_driven_chain.toml")
    run = sf.run(case, progress=False)
    run.save(folder / "run")
    study = sf.Study(case, axes={"drive.direction": [0, 45, 90, 135]}, replicates=2)
    simulation = sf.Simulation(case)
    simulation.step(30)
    simulation.change({"drive.v_star": 0.1})
    simulation.step(5)
    (folder / "paper" / "found").mkdir(parents=True)
    (folder / "paper" / "claims.csv").write_text("number,claim\n1,it slips\n")
    (folder / "paper" / "fig03.png").write_bytes(b"")
    (folder / "paper" / "fig03.csv").write_text("t,mu\n0,0\n1,0.5\n")
    made = {
        "case": case,
        "run": run,
        "run at an edge": sf.run(edge, progress=False),
        "opened run": sf.open(folder / "run"),
        "simulation": simulation,
        "study": study.run(progress=False),
        "convergence": sf.converge(sf.Case(SLIDER_ON_MESHES), progress=False),
        "paper": sf.open(folder / "paper", verify=False),
    }
    unpickled = {f"unpickled {name}": pickle.loads(pickle.dumps(holder)) for name, holder in made.items()}
    return made | unpickled


@pytest.mark.parametrize("without", [(), ("xarray", "pandas")])
def test_nothing_that_is_handed_out_can_be_spoilt(
    without: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in without:
        monkeypatch.setitem(sys.modules, module, None)
    all_of_them = holders(tmp_path)
    before = {name: content(list(handed_out(holder))) for name, holder in all_of_them.items()}
    met = {name: sum(spoil(value) for _, value in handed_out(holder)) for name, holder in all_of_them.items()}
    for name, holder in all_of_them.items():
        for (what, value), found in zip(handed_out(holder), before[name], strict=True):
            assert content((what, value)) == found, f"{what} of the {name}"
    # Each has arrays, and the largest of them many.
    assert all(met.values()) and met["run"] > 30 and met["simulation"] > 20, met


def test_arrays_that_are_shared_say_that_they_cannot_be_written_to(small: sf.Case) -> None:
    run = sf.run(small, progress=False)
    for array in (run.fields["traction"].values, run.series["mu_star"].values, run.series["time_star"].values, run.front):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    with pytest.raises(ValueError, match="read-only"):
        run.series["mu_star"] *= 2
    # A copy, or what is computed, can be changed.
    copied = run.fields.copy(deep=True)
    copied["traction"].values[...] = 0
    assert run.fields["traction"].values.max() > 0
    twice = 2 * run.series["mu_star"]
    twice[0] = 1
    frame = run.series.to_dataframe()
    frame["mu_star"] = 0.0
    assert run.series["mu_star"].values.max() == run.static_friction_star
