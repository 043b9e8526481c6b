"""Cases from everywhere, and what is wrong with them."""

import io
import math
import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipfront as sf
from slipfront._toml import npy


def test_a_case_is_the_same_from_a_path_a_text_and_a_dictionary() -> None:
    path = Path("cases/circle.toml")
    loaded = sf.Case.load(path)
    tables = {
        "slider": {"blocks": [50, 50]},
        "friction": {"sigma_static_star": 0},
        "texture": [{"shape": "cavity", "coverage": 10}],
    }
    assert sf.Case.parse(path.read_text()).to_toml() == loaded.to_toml()
    assert sf.Case(tables).to_toml() == sf.Case(tables).to_toml() == loaded.to_toml()
    assert loaded == sf.Case.load(str(path))
    assert hash(loaded) == hash(sf.Case.load(str(path)))
    assert loaded != loaded.replace({"drive.v_star": 0.5})


def test_overrides_replace_keys_that_exclude_them() -> None:
    case = sf.Case.load("cases/circle.toml", {"drive.speed": "1 mm/s", "texture.0.coverage": 5})
    assert case.numbers["v_star"] != 0.01
    assert round(case.numbers["texture_percent"]) == 5
    assert case.replace({"texture": []}).numbers["texture_percent"] == 0


def test_a_table_that_is_replaced_keeps_the_keys_that_are_not_given() -> None:
    case = sf.Case({"slider": {"blocks": [4, 4]}, "drive": {"v_star": 0.05, "direction": 45}})
    changed = case.replace({"drive": {"v_star": 0.1}})
    assert changed == case.replace({"drive.v_star": 0.1}) and "direction = 45" in changed.to_toml()
    study = sf.Study(case, axes={"speed": {"slow": {}, "fast": {"drive": {"v_star": 0.1}}}})
    assert study.case(1).numbers == changed.numbers and "direction = 45" in study.case(1).to_toml()


def test_values_may_be_those_of_numpy_and_of_pint() -> None:
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    written = sf.Case({"slider": {"blocks": [4, 4]}, "drive": {"speed": "1.5 mm/s"}, "load": {"pressure": "50 kPa"}})
    given = sf.Case(
        {
            "slider": {"blocks": np.array([4, 4])},
            "drive": {"speed": 1.5 * unit.mm / unit.s},
            "load": {"pressure": unit.Quantity(np.float64(50.0), "kPa")},
        }
    )
    assert given.numbers == written.numbers
    with pytest.raises(sf.CaseError, match="give a speed"):
        sf.Case({"drive": {"speed": 3 * unit.kg}})


def test_errors_have_the_sentences_of_the_command() -> None:
    with pytest.raises(sf.CaseError) as raised:
        sf.Case.parse("[drive]\nv_start = 0.1\n", name="mine")
    assert "mine:2:1" in str(raised.value) and "v_star" in str(raised.value)
    assert (raised.value.line, raised.value.column) == (2, 1)
    assert isinstance(raised.value, ValueError)
    with pytest.raises(sf.CaseError, match="did you mean cases/circle.toml") as raised:
        sf.Case.load("cases/cirle.toml")
    assert raised.value.line is None
    with pytest.raises(sf.CaseError, match="^drive.v_star=0: "):
        sf.Case.load("cases/circle.toml", {"drive.v_star": 0})
    with pytest.raises(sf.CaseError, match="not of object"):
        sf.Case({"drive": {"v_star": object()}})
    with pytest.raises(TypeError, match="a dictionary of its tables, not from str: from a file by Case.load"):
        sf.Case("cases/circle.toml")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("tables", "sentence"),
    [
        ({1: 2}, "a text such as 'drive', not 1"),
        ({"slider": {1: 2}}, "a text such as 'drive', not 1"),
        ({1: [{"shape": "cavity"}]}, "a text such as 'drive', not 1"),
        ({"texture": [{b"shape": "cavity"}]}, "a text such as 'drive', not b'shape'"),
        ({"slider": {"blocks": b"\x05\x05"}}, "`slider.blocks`: .* not of bytes"),
        ({"drive": {"v_star": bytearray(b"1")}}, "`drive.v_star`: .* not of bytearray"),
    ],
)
def test_keys_are_texts_and_numbers_no_bytes(tables: Any, sentence: str) -> None:
    with pytest.raises(sf.CaseError, match=sentence) as raised:
        sf.Case(tables)
    assert raised.value.line is None and raised.value.column is None
    with pytest.raises(sf.CaseError, match=sentence.replace("`slider.blocks`: .*", "").replace("`drive.v_star`: .*", "")):
        sf.Case({}, tables)


def test_a_star_import_leaves_the_functions_of_python() -> None:
    import builtins

    taken = set(sf.__all__) & set(dir(builtins))
    assert not taken and callable(sf.open) and callable(sf.map)


def test_a_file_that_is_missing_is_one_for_python_too(tmp_path: Path) -> None:
    for missing in ("cases/cirle.toml", tmp_path / "none.toml"):
        for use in (sf.Case.load, sf.run, sf.Study):
            with pytest.raises(FileNotFoundError) as raised:
                use(missing)
            assert isinstance(raised.value, sf.CaseError) and raised.value.line is None
            assert type(pickle.loads(pickle.dumps(raised.value))) is type(raised.value)
    for read in (sf.open, sf.open_run, sf.open_study):
        with pytest.raises(FileNotFoundError, match="there is no folder") as lost:
            read(tmp_path / "none")
        assert isinstance(lost.value, sf.FolderError)
    with pytest.raises(sf.CaseError) as folder:
        sf.Case.load(tmp_path)
    assert not isinstance(folder.value, FileNotFoundError)


def test_a_case_is_a_dictionary_again(tmp_path: Path) -> None:
    mask = np.eye(10, 12, dtype=bool)
    np.save(tmp_path / "mask.npy", mask)
    tables: dict[str, Any] = {
        "slider": {"blocks": [12, 10]},
        "load": {"pressure_field": np.full((10, 12), 0.9)},
        "texture": [{"shape": "mask", "file": mask}, {"shape": "groove", "coverage": 10}],
        "output": {"snapshots": {"every": 100}},
    }
    in_memory = sf.Case(tables)
    tables["texture"][0]["file"] = tmp_path / "mask.npy"
    for case in (in_memory, sf.Case(tables), pickle.loads(pickle.dumps(in_memory)), sf.Case.load("cases/circle.toml")):
        again = sf.Case(case.to_dict(), name=case.name)
        assert again == case and (again.textured == case.textured).all()
        # What is changed in the dictionary changes another case.
        case.to_dict()["slider"]["blocks"][0] = 1
        assert again == case
    assert (in_memory["texture.0.file"] == mask).all() and in_memory["texture.1.coverage"] == 10
    assert sf.Case(tables)["texture.0.file"] == str(tmp_path / "mask.npy")
    assert in_memory["drive"]["v_star"] == in_memory["drive.v_star"] == in_memory.numbers["v_star"]
    for key, told in (("drive.v_stra", "`drive` of the case has no `v_stra`"), ("texture.2", "has no `2`: it has 0, 1"), ("speed", "the case has no `speed`")):
        with pytest.raises(KeyError, match=told):
            in_memory[key]
    with pytest.raises(KeyError, match="has no `x`: it has no keys"):
        in_memory["drive.v_star.x"]
    with pytest.raises(TypeError, match="not 0"):
        list(in_memory)  # type: ignore[call-overload]


def test_rows_of_a_list_are_a_mask_and_a_field() -> None:
    mask, field = np.eye(10, 12, dtype=int), np.linspace(0.8, 1.2, 120).reshape(10, 12)

    def case(texture: Any, pressure: Any) -> sf.Case:
        return sf.Case({"slider": {"blocks": [12, 10]}, "load": {"pressure_field": pressure}, "texture": [{"shape": "mask", "file": texture}]})

    of_arrays = case(mask, field)
    for rows in (mask.tolist(), [tuple(row) for row in mask.tolist()], [[bool(one) for one in row] for row in mask]):
        of_rows = case(rows, field.tolist())
        assert (of_rows.textured == of_arrays.textured).all() and sf.map([of_rows]) == sf.map([of_arrays])
    study = sf.Study(of_arrays, axes={"texture.0.file": [mask.tolist(), (1 - mask).tolist()]})
    assert [study.case(point).textured.sum() for point in (0, 1)] == [10, 110]
    for wrong in ([[0, 1], [1]], [0, 1], [["a"]]):
        with pytest.raises(ValueError, match="`texture.0.file` is the name of a file, an array"):
            case(wrong, field)
    with pytest.raises(sf.CaseError, match=r"`texture.0.file` has the shape \(2, 2\) where \(10, 12\)") as raised:
        case([[0, 1], [1, 0]], field)
    assert "memory:" not in str(raised.value)


def test_a_case_never_changes() -> None:
    case = sf.Case.load("cases/circle.toml")
    with pytest.raises(AttributeError, match="never changes"):
        case.name = "other"  # type: ignore[misc]
    for array in (case.textured, case.mu_static, case.mu_kinetic):
        assert array.shape == (50, 50)
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 0
        # The memory is the case's, on which the `unsafe` of arrays.rs stands.
        with pytest.raises(ValueError, match="cannot set WRITEABLE"):
            array.setflags(write=True)
    # The array holds what it shows.
    textured = case.textured
    before = textured.copy()
    del case
    assert (textured == before).all()


def test_arrays_stand_in_for_files_and_are_pickled() -> None:
    rng = np.random.default_rng(3)
    mask = np.zeros((12, 20), dtype=bool)
    mask[3:7, 5:9] = True
    coefficients = rng.uniform(0.8, 1.2, (12, 20))
    case = sf.Case(
        {
            "slider": {"blocks": [20, 12]},
            "friction": {"mu_static_field": coefficients},
            "texture": [{"shape": "mask", "file": mask}],
        }
    )
    assert (case.textured == mask).all()
    assert np.allclose(case.mu_static[~mask] / coefficients[~mask], case.mu_static[0, 0] / coefficients[0, 0], rtol=1e-12)
    changed = case.replace({"drive.v_star": 0.5})
    twin = pickle.loads(pickle.dumps(case))
    assert twin == case
    del case
    assert (changed.textured == mask).all() and (changed.replace({}).textured == mask).all()
    assert (twin.mu_static == changed.mu_static).all()


def test_arrays_in_memory_make_no_folder(tmp_path: Path) -> None:
    """Neither a case that is made, changed, pickled or run does, nor one that another process has pickled."""
    program = """
import os, pickle
import numpy as np
import slipfront as sf

mask = np.eye(3, 4, dtype=bool)
case = sf.Case({"slider": {"blocks": [4, 3]}, "texture": [{"shape": "mask", "file": mask}], "time": {"duration_star": 5}})
other = sf.Case.load("cases/circle.toml", {"slider.blocks": [4, 3], "texture": [{"shape": "mask", "file": ~mask}]})
assert (other.textured == ~mask).all()
twin = pickle.loads(pickle.dumps(case.replace({"drive.v_star": 0.2})))
assert (twin.textured == mask).all() and (twin.replace({"friction.seed": 2}).textured == mask).all()
sf.map([case, twin])
sf.run(case, progress=False)
simulation = sf.Simulation(case)
simulation.textured = ~mask
assert (simulation.textured == ~mask).all()
print(os.listdir(os.environ["TMPDIR"]))
"""
    env = os.environ | {"TMPDIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", program], env=env, stdout=subprocess.PIPE, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_an_array_is_the_file_of_numpy_with_its_values(tmp_path: Path) -> None:
    """A saved run with arrays has the bytes of a run that reads files, and a whole case."""
    rng = np.random.default_rng(8)
    mask, coefficients = rng.random((10, 12)) < 0.1, rng.uniform(0.8, 1.2, (10, 12))

    def tables(texture: object, field: object) -> dict[str, Any]:
        return {
            "slider": {"blocks": [12, 10]},
            "time": {"duration_star": 60},
            "texture": [{"shape": "mask", "file": texture}],
            "friction": {"mu_static_field": field},
        }

    paths = [tmp_path / "texture.0.file.npy", tmp_path / "friction.mu_static_field.npy"]
    for path, array in zip(paths, (mask, coefficients), strict=True):
        np.save(path, array)
    on_disk = sf.Case(tables(*paths))
    in_memory = sf.Case(tables(mask, coefficients))
    assert in_memory == on_disk and in_memory._hashes() == on_disk._hashes()
    saved = [sf.run(case, progress=False).save(tmp_path / name) for case, name in ((on_disk, "disk"), (in_memory, "memory"))]
    files = [sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file()) for folder in saved]
    assert files[0] == files[1] and Path("inputs") / paths[1].name in files[0]
    for file in files[0]:
        assert file.name == "manifest.json" or (saved[0] / file).read_bytes() == (saved[1] / file).read_bytes(), file
    again = sf.Case.load(saved[1] / "case.toml")
    assert again == in_memory and sf.map([again]) == sf.map([in_memory])


@pytest.mark.parametrize("dtype", ["?", "u1", "<i4", ">i8", "<f4", ">f8", "<c16", "O", "M8[s]", [("a", "<f8"), ("b", "?")]])
def test_arrays_in_memory_are_what_numpy_saves(dtype: Any) -> None:
    """The header that is kept from array to array is that of each."""
    for shape in ((3, 4), (4, 3), (0, 5)):
        for array in (np.zeros(shape, dtype), np.zeros(shape, dtype, order="F"), np.zeros(shape[::-1], dtype).T[:, ::-2]):
            file = io.BytesIO()
            np.save(file, np.ascontiguousarray(array))
            expected = file.getvalue()
            # Numpy writes objects as pickles, which no case reads; their file here has nothing but the right
            # header.
            end = len(expected) - array.nbytes if array.dtype != object else expected.index(b"\n")
            assert npy(array)[:end] == expected[:end] and (array.dtype == object or npy(array) == expected)


def test_arrays_are_a_load_and_a_start(tmp_path: Path) -> None:
    """Arrays in place of files: a shear load, displacements and velocities, and the last state of a run."""
    shear, push = np.full((6, 8), 2.0), np.zeros((6, 8))
    push[:, 0] = 0.5
    tables: dict[str, Any] = {
        "slider": {"blocks": [8, 6]},
        "load": {"shear_star": 0.2, "shear_field": shear},
        "initial": {"velocity_x": push, "displacement_y": push.tolist(), "displacement_unit": "1 pm"},
        "time": {"duration_star": 5},
        "output": {"final_state": True, "snapshots": [0]},
    }
    case = sf.Case(tables)
    run = sf.run(case, progress=False)
    # Twice 0.2, and the stretch of half a step of the velocities.
    assert run.series["mu_star"].values[0] == pytest.approx(0.4, abs=1e-3)
    assert (run.front[:, 0] == 0).all()
    with pytest.raises(sf.CaseError, match=r"`initial.velocity_x` has the shape \(6, 7\) where \(6, 8\)"):
        case.replace({"initial.velocity_x": push[:, 1:]})
    with pytest.raises(sf.CaseError, match=r"`initial.state_file` has the shape \(6, 8\) where the last state"):
        sf.Case(tables | {"initial": {"state_file": push}})
    state = np.zeros((4, 6, 8))
    state[2, 0, 0] = 1e-3
    begun = sf.run(sf.Case(tables | {"initial": {"state_file": state}}), progress=False)
    assert begun.front[0, 0] == 0 and (run.save(tmp_path / "run") / "state.npy").is_file()
    assert np.load(tmp_path / "run" / "state.npy").shape == (4, 6, 8)


def test_arrays_of_objects_are_refused() -> None:
    mask = np.array([[None, 1]])
    with pytest.raises(sf.CaseError, match="`texture.0.file`"):
        sf.Case({"slider": {"blocks": [2, 1]}, "texture": [{"shape": "mask", "file": mask}]})


def test_arrays_follow_a_case(tmp_path: Path) -> None:
    """Arrays of a case that is changed stand beside new ones, and beside files of their names."""
    mask, field = np.eye(10, 12, dtype=bool), np.full((10, 12), 0.9)
    case = sf.Case({"slider": {"blocks": [12, 10]}, "texture": [{"shape": "mask", "file": mask}]})
    both = pickle.loads(pickle.dumps(case.replace({"load.pressure_field": field}))).replace({"friction.mu_static_field": field + 1})
    assert (both.textured == mask).all() and both.mu_static[0, 1] == both.mu_static.max()
    named = ("texture.0.file", "load.pressure_field", "friction.mu_static_field")
    assert set(both._hashes()) == {f"inputs/{key}.npy" for key in named}
    twice = case.replace({"texture": [{"shape": "mask", "file": mask}, {"shape": "mask", "file": mask[::-1]}]})
    assert (twice.textured == mask | mask[::-1]).all()
    np.save(tmp_path / "mask.npy", ~mask)
    text = 'slider.blocks = [12, 10]\n[[texture]]\nshape = "mask"\nfile = "mask.npy"\n'
    beside = sf.Case.parse(text, {"friction.mu_static_field": field}, folder=tmp_path)
    assert (beside.textured == ~mask).all() and len(beside._hashes()) == 2
    with pytest.raises(sf.CaseError, match=r"`friction.mu_static_field` has the shape \(3, 4\) where \(10, 12\)"):
        case.replace({"friction.mu_static_field": field[:3, :4]})
    with pytest.raises(sf.CaseError, match="`friction.mu_static_field` has 80128 bytes where 10 rows of 12 numbers take at most"):
        case.replace({"friction.mu_static_field": np.ones((100, 100))})
    study = sf.Study(both, axes={"texture.0.file": [mask, ~mask], "drive.v_star": [0.2]}, keep="all")
    results = study.run(tmp_path / "study", progress=False)
    assert list(results.runs["texture_percent"]) == [pytest.approx(100 / 12), pytest.approx(1100 / 12)]


def test_a_file_that_changes_does_not_change_the_case_in_silence(tmp_path: Path) -> None:
    def written(blocks: int) -> None:
        mask = np.zeros((10, 12), dtype=bool)
        mask[0, :blocks] = True
        np.save(tmp_path / "mask.npy", mask)

    written(3)
    (tmp_path / "mine.toml").write_text('slider.blocks = [12, 10]\n[[texture]]\nshape = "mask"\nfile = "mask.npy"\n')
    case = sf.Case.load(tmp_path / "mine.toml")
    same, simulation = case.replace({}), sf.Simulation(case)
    written(5)
    assert case == same and case.textured.sum() == 3
    uses: dict[str, Callable[[], object]] = {
        "pickle": lambda: pickle.dumps(case),
        "replace": lambda: case.replace({"drive.v_star": 0.1}),
        "change": lambda: simulation.change({"drive.v_star": 0.1}),
        "study": lambda: sf.Study(case, axes={"drive.v_star": [0.1]}),
    }
    for use in uses.values():
        with pytest.raises(sf.CaseError, match="mask.npy has changed since the case was prepared: load the case again") as raised:
            use()
        assert raised.value.line is None and raised.value.column is None
    assert sf.Case.load(tmp_path / "mine.toml") != case
    written(3)
    assert pickle.loads(pickle.dumps(case)) == case
    (tmp_path / "mask.npy").unlink()
    with pytest.raises(sf.CaseError, match="mask.npy, which the case reads, cannot be read again"):
        case.replace({})


def test_masked_heights_are_not_taken_for_measured_ones() -> None:
    heights = np.ma.masked_greater(np.random.default_rng(1).normal(size=(12, 20)), 1.0)
    texture = {"shape": "height_map", "file": heights, "height_unit": "1 nm", "pixel_size": "1 um", "bearing_percent": 50}
    tables = {"slider": {"blocks": [20, 12]}, "texture": [texture]}
    with pytest.raises(sf.CaseError, match="NaN|not measured|no number|finite"):
        sf.Case(tables)
    texture["file"] = heights.filled(1.0)
    assert sf.Case(tables).numbers["texture_percent"] == 50


def test_what_is_no_number_is_told_by_its_index(small: sf.Case) -> None:
    """In every array that is given, whoever reads it."""
    holed = np.ones(small.shape)
    holed[3, 5] = math.nan
    texture = {"shape": "height_map", "file": holed, "height_unit": "1 nm", "pixel_size": "1 um", "bearing_percent": 50}
    design = sf.Design(small, wish=sf.Least("static_friction"), coverage=(0, 40))
    rig = {"slider": {"blocks": [6, 6]}, "time": {"step": 0.4}}
    calibration = sf.Calibration(rig, unknowns={"friction.mu_static": (0.3, 0.9)}, noise=0.01)
    force = np.ones(50)
    force[7] = math.inf
    given: dict[str, Callable[[], object]] = {
        r"`friction.mu_static_field\[3, 5\]` is NaN": lambda: small.replace({"friction.mu_static_field": holed}),
        r"`load.pressure_field\[0, 1\]` is inf": lambda: small.replace({"load.pressure_field": np.where(np.arange(12) == 1, math.inf, 1.0) * np.ones(small.shape)}),
        r"`texture.0.file\[3, 5\]` is NaN, but must be 0 or 1": lambda: small.replace({"texture": [{"shape": "mask", "file": holed}]}),
        r"`texture.0.file\[3, 5\]` is NaN, but must have a height": lambda: small.replace({"texture": [texture]}),
        r"`output.snapshots\[1\]` is NaN": lambda: small.replace({"output.snapshots": np.array([1, math.nan])}),
        r"`drive.v_star\[1\]` is NaN": lambda: sf.Study(small, axes={"drive.v_star": np.array([1, math.nan])}),  # type: ignore[dict-item]
        r"`mask\[3, 5\]` is NaN": lambda: design.illegal(holed),
        r"`losses\[0\]` is NaN": lambda: design.tell([holed > 0], [math.nan]),
        r"`force_n\[7\]` is inf": lambda: calibration.check((np.arange(50) * 1e-9, force)),
    }
    for said, give in given.items():
        with pytest.raises(ValueError, match=said):
            give()
    simulation = sf.Simulation(small)
    with pytest.raises(ValueError, match=r"`mask\[3, 5\]` is NaN"):
        simulation.textured = holed


def test_a_surface_has_the_same_contact_from_every_file_of_surface_topography(tmp_path: Path) -> None:
    library = pytest.importorskip("SurfaceTopography")
    # Without symmetry: a mirrored or turned surface touches elsewhere.
    heights = np.random.default_rng(1).normal(size=(20, 12))
    surface = library.Topography(heights * 1e-6, (20e-6, 12e-6), unit="m")
    rows = surface.heights().T[::-1]
    np.save(tmp_path / "array.npy", rows)
    np.savetxt(tmp_path / "array.csv", rows)
    for number in "DFLI":
        surface.to_x3p(str(tmp_path / f"{number}.x3p"), dtype=number)

    def contact(file: object, **units: str) -> np.ndarray:
        texture = {"shape": "height_map", "file": file, "bearing_percent": 50, **units}
        return ~sf.Case({"slider": {"blocks": [20, 12]}, "texture": [texture]}).textured

    # The library shows heights()[:, 0] on top, where y is largest; half of an even number of blocks touch.
    wanted = (heights > np.median(heights)).T[::-1]
    for file in (str(tmp_path / "array.npy"), str(tmp_path / "array.csv"), rows):
        assert (contact(file, height_unit="1 m", pixel_size="1 um") == wanted).all(), file
    for number in "DFLI":
        assert (contact(str(tmp_path / f"{number}.x3p")) == wanted).all(), number


def test_a_case_shows_its_physics() -> None:
    case = sf.Case.load("cases/circle.toml")
    assert "50 x 50 blocks" in repr(case)
    shown = case._repr_html_()
    assert "data:image/png" in shown and "50 x 50 blocks" in shown


def test_what_a_killed_process_has_left_goes_with_the_next(tmp_path: Path) -> None:
    program = """
import os, signal
import numpy as np
import slipfront as sf

case = sf.Case({"slider": {"blocks": [4, 3]}, "texture": [{"shape": "mask", "file": np.eye(3, 4, dtype=bool)}]})
study = sf.Study(case, axes={"drive.v_star": [0.2]})
if os.fork() == 0:
    # It has the files of the study's arrays in common with the process that made them.
    del study
    raise SystemExit
os.wait()
assert sf.Study(case, axes={"drive.v_star": [0.2]}).n_points == study.n_points == 1
print(len(os.listdir(os.environ["TMPDIR"])), flush=True)
if KILLED:
    os.kill(os.getpid(), signal.SIGKILL)
"""

    def left(*, killed: bool) -> tuple[str, int]:
        line = [sys.executable, "-c", f"KILLED = {killed}\n{program}"]
        done = subprocess.run(line, env=os.environ | {"TMPDIR": str(tmp_path)}, stdout=subprocess.PIPE, text=True, check=False)
        assert done.returncode == (-signal.SIGKILL if killed else 0)
        return done.stdout.strip(), len(list(tmp_path.iterdir()))

    assert [left(killed=True), left(killed=True), left(killed=False)] == [("1", 1), ("1", 1), ("1", 0)]
