"""Cases are given and keys are named alike everywhere."""

# A misspelt argument is an error to pyright: were it none, the comment that allows it would be one.
# pyright: reportUnnecessaryTypeIgnoreComment=true

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipfront as sf
from slipfront import _keys

TABLES: dict[str, Any] = {"slider": {"blocks": [6, 4]}, "drive": {"v_star": 0.3}, "time": {"stop": "after_onset"}}
OVERRIDES = {"drive.v_star": 0.1, "texture": [{"shape": "mask", "file": np.eye(4, 6, dtype=bool)}]}
UNKNOWNS: dict[str, _keys.Range] = {"friction.mu_static": (0.3, 0.9)}
USES: dict[str, Callable[..., object]] = {
    "run": lambda *case: sf.run(*case, progress=False).summary,
    "map": lambda case, *overrides: sf.map([case], *overrides),
    "Simulation": lambda *case: sf.Simulation(*case).case.to_toml(),
    "Study": lambda *case: sf.Study(*case, axes={"friction.seed": [1, 2]}).case(0).to_toml(),
    "Design": lambda *case: sf.Design(*case, wish=sf.Least("static_friction"), coverage=(0, 40)).ask(1)[0].tolist(),
    "Calibration": lambda *case: sf.Calibration(*case, unknowns=UNKNOWNS, noise=0.01, name="mine").name,
}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """The file of the tables."""
    path = tmp_path / "case.toml"
    path.write_text('[slider]\nblocks = [6, 4]\n[drive]\nv_star = 0.3\n[time]\nstop = "after_onset"\n')
    return path


@pytest.mark.parametrize("use", USES)
def test_cases_tables_and_files_are_taken_with_overrides_behind_them(use: str, path: Path) -> None:
    wanted = USES[use](sf.Case(TABLES, OVERRIDES))
    for given in (TABLES, path, str(path), sf.Case(TABLES)):
        assert USES[use](given, OVERRIDES) == wanted
    assert sf.Case(TABLES, OVERRIDES) == sf.Case(TABLES).replace(OVERRIDES) == sf.Case.load(path, OVERRIDES)
    with pytest.raises(TypeError, match=r"keys to change are a dictionary .* not 'results': give other arguments by name"):
        USES[use](TABLES, "results")


def test_meshes_take_overrides(path: Path) -> None:
    changed = {"drive.v_star": 0.1}
    wanted = sf.converge(sf.Case(TABLES, changed), replicates=1, progress=False).to_dict()
    assert sf.converge(path, changed, replicates=1, progress=False).to_dict() == wanted


def test_a_checkpoint_goes_on_with_any_form_of_its_case(path: Path) -> None:
    simulation = sf.Simulation(path)
    simulation.step(10)
    for given in (TABLES, path, sf.Case(TABLES)):
        assert sf.Simulation.resume(given, simulation.checkpoint()).steps == 10


def test_files_of_studies_designs_and_calibrations_take_overrides(path: Path, tmp_path: Path) -> None:
    tables = {
        "study": '[[axes]]\nkey = "friction.seed"\nlist = [1]\n',
        "design": '[design]\nwish = { least = "static_friction" }\ncoverage = [0, 40]\nruns = 8\n',
        "calibration": '[calibrate]\nx = "time_s"\ny = "force_n"\nnoise = 0.01\nunknowns = { "friction.mu_static" = [0.3, 0.9] }\n',
    }
    files = {name: tmp_path / f"my-{name}.toml" for name in tables}
    for name, text in tables.items():
        files[name].write_text(f'base = "{path.name}"\n{text}')
    case = sf.Study(files["study"], OVERRIDES).case(0)
    assert case["drive.v_star"] == 0.1 and (case.textured == np.eye(4, 6, dtype=bool)).all()
    with pytest.raises(sf.CaseError, match="an axis of the study sets `friction.seed`"):
        sf.Study(files["study"], {"friction.seed": 2})
    design = sf.Design(files["design"], {"slider.blocks": [8, 8]})
    assert design.ask(1)[0].shape == (8, 8)
    assert sf.Calibration(files["calibration"], OVERRIDES).name == "my-calibration"
    with pytest.raises(sf.CaseError, match="did you mean `v_star`"):
        sf.Study(files["study"], {"drive.v_start": 1})
    with pytest.raises(sf.CaseError, match="did you mean `v_star`"):
        sf.Design(files["design"], {"drive.v_start": 1})


def keys_of(reference: str, heading: str) -> set[str]:
    """Keys of a table of a reference."""
    text = Path(f"docs/reference/{reference}-file.md").read_text(encoding="utf-8")
    section = re.split(r"^##+ ", text.split(f"\n{heading}\n", 1)[1], maxsplit=1, flags=re.MULTILINE)[0]
    return set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE))


@pytest.mark.parametrize(
    ("keys", "reference", "heading", "arguments"),
    [
        (_keys.StudyKeys, "study", "## `[study]`", {"replicates"}),
        (_keys.UntilKeys, "study", "### `until`", set[str]()),
        (_keys.DesignKeys, "design", "## `[design]`", {"wish", "coverage"}),
        (_keys.CalibrationKeys, "calibration", "## `[calibrate]`", {"unknowns", "noise", "x", "y"}),
        (_keys.InstrumentKeys, "calibration", "## `[instrument]`", set[str]()),
    ],
)
def test_arguments_are_the_keys_of_the_files(keys: Any, reference: str, heading: str, arguments: set[str]) -> None:
    named: Mapping[str, object] = keys.__annotations__
    assert {key.removesuffix("_") for key in named} | arguments == keys_of(reference, heading)


def test_misspelt_keys_are_told_at_once() -> None:
    """To a type checker too."""
    least = sf.Least("static_friction")
    with pytest.raises(sf.CaseError, match="did you mean `feature_blocks`"):
        sf.Design(TABLES, wish=least, coverage=(0, 40), feature_block=2)  # type: ignore[call-arg]
    with pytest.raises(sf.CaseError, match="did you mean `finer_runs`"):
        sf.Calibration(TABLES, unknowns=UNKNOWNS, noise=0.01, finer_run=0)  # type: ignore[call-arg]
    with pytest.raises(sf.CaseError, match="did you mean `cutoff`"):
        sf.Calibration(TABLES, unknowns=UNKNOWNS, noise=0.01, instrument={"cuttoff": "1 Hz"})  # type: ignore[arg-type]
    with pytest.raises(sf.CaseError, match="did you mean `reference`"):
        sf.Study(TABLES, axes={"friction.seed": [1]}, refrence={})  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="labl"):
        sf.run(TABLES, progress=False).plot(labl="mine")  # type: ignore[call-arg]
    with pytest.raises(sf.CaseError, match='did you mean "mean"|"worst"'):
        sf.Design(TABLES, wish=least, coverage=(0, 40), judge_by="worse")  # type: ignore[arg-type]


def test_a_word_of_python_is_a_key() -> None:
    made = sf.Calibration(TABLES, unknowns=UNKNOWNS, noise=0.01, from_="1 ns", to="2 ns")
    assert made.name == "case-calibration"
