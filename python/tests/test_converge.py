"""One slider on several meshes."""

import json
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipfront as sf

from .test_command import command

pytest.importorskip("pandas")

# All lengths are those of the material; small enough for a test.
SHEET = """
[slider]
blocks = [20, 20]
block_size = "50 um"
thickness = "20 um"
[drive]
v_star = 0.02
stiffness_per_area = "1875 MPa/um"
[friction]
sigma_static_star = 0
sigma_kinetic_star = 0
slip_weakening = { length_star = 0.4 }
[time]
stop = "after_onset"
[[texture]]
shape = "cavity"
coverage = 10
"""


@pytest.fixture
def sheet(tmp_path: Path) -> Path:
    path = tmp_path / "sheet.toml"
    path.write_text(SHEET)
    return path


def files(folder: Path) -> dict[str, bytes]:
    """Every file of a folder but the journal, whose lines have times and stand in the order in which runs ended, and its hash."""
    every = (path for path in folder.rglob("*") if path.is_file() and path.name not in ("runs.jsonl", "checksums.json"))
    return {str(path.relative_to(folder)): path.read_bytes() for path in every}


def converged_by_command(case: Path, folder: Path, *arguments: str) -> dict[str, Any]:
    """Results of the command, which it writes to a folder."""
    ran = command("converge", case, "-o", folder, "--quiet", *arguments)
    assert ran.returncode == 0, ran.stderr
    return dict(json.loads((folder / "convergence.json").read_bytes()))


def test_a_folder_has_the_bytes_of_the_command(sheet: Path, tmp_path: Path) -> None:
    expected = converged_by_command(sheet, tmp_path / "command")
    found = sf.converge(sheet, folder=tmp_path / "python", progress=False)
    assert found.to_dict() == expected and found.folder == tmp_path / "python"
    ours = files(tmp_path / "python")
    assert ours == files(tmp_path / "command") and {"convergence.json", "convergence.txt", "points.csv"} <= set(ours)
    in_memory = sf.converge(sf.Case.load(sheet), progress=False)
    assert in_memory.folder is None and in_memory.to_dict() == expected and in_memory.text == found.text


def test_every_quantity_has_its_values_errors_and_sentence(sheet: Path) -> None:
    found = sf.converge(sheet, progress=False)
    assert found.block_sizes == ["100 um", "50 um", "25 um"] and found.coverages == [12, 11, 10.25]
    assert found.lengths_of_a_block == [] and repr(found) == found.text.rstrip()
    assert list(found.quantities) == ["static_reduction_percent", "static_friction_star"]
    friction = found.quantities["static_friction_star"]
    # The second mesh is that of the case.
    assert friction.values[1] == sf.run(sheet, progress=False).static_friction_star
    assert friction.scatter == (None, None, None)
    # As MeshVerdict::on, of differences that fall by more than second order: a quarter of the first, of which a
    # third is left.
    first, last = friction.values[1] - friction.values[0], friction.values[2] - friction.values[1]
    assert abs(last) < abs(first) / 4 and friction.order == 2
    assert friction.mesh_error == max(abs(last), abs(first) / 12)
    assert repr(friction) == friction.sentence
    assert friction.sentence.startswith("static_friction_star: 1.00") and "(discretisation " in friction.sentence
    row = found.to_list()[1]
    assert row["quantity"] == "static_friction_star" and row["values"] == friction.values
    assert found.points.query("quantity == 'static_friction_star'")["mean"].tolist() == list(friction.values)


def test_no_limit_is_claimed_where_a_block_is_a_length_of_the_material(tmp_path: Path) -> None:
    path = tmp_path / "naive.toml"
    path.write_text("slider.blocks = [20, 20]\ntime.stop = 'after_onset'\n")
    expected = converged_by_command(path, tmp_path / "command", "--replicates", "2", "--levels", "4")
    found = sf.converge(path, levels=4, replicates=2, progress=False)
    assert found.to_dict() == expected and len(found.block_sizes) == 4
    friction = found.quantities["static_friction_star"]
    assert all(half is not None and half > 0 for half in friction.scatter)
    assert friction.mesh_error is None and "this value depends on the mesh" in friction.sentence
    assert any("slider.thickness" in length for length in found.lengths_of_a_block)


def test_a_picture_is_laid_over_every_mesh_and_copied(tmp_path: Path) -> None:
    case = Path("cases/mask.toml")
    expected = converged_by_command(case, tmp_path / "command", "--replicates", "1", "--set", "time.stop=after_onset")
    found = sf.converge(sf.Case.load(case, {"time.stop": "after_onset"}), folder=tmp_path / "python", replicates=1, progress=False)
    assert found.to_dict() == expected and all(10 < percent < 90 for percent in found.coverages)
    ours = files(tmp_path / "python")
    assert ours == files(tmp_path / "command") and "inputs/herringbone.png" in ours


def test_a_folder_is_opened_and_held_against_its_records(sheet: Path, tmp_path: Path) -> None:
    folder = tmp_path / "meshes"
    found = sf.converge(sheet, folder=folder, progress=False)
    opened = sf.open(folder)
    assert isinstance(opened, sf.Convergence)
    assert opened.to_dict() == found.to_dict() and opened.text == found.text and opened.runs.equals(found.runs)
    told = folder / "convergence.json"
    told.write_text(told.read_text().replace("1.00", "1.01", 1))
    with pytest.raises(sf.FolderError, match="convergence.json differs: other bytes were written"):
        sf.open(folder)
    # An edited file is replaced on demand, as the records give it.
    with pytest.raises(sf.FolderError, match="convergence.json; .* by `force=True`"):
        sf.converge(sheet, folder=folder, progress=False)
    sf.converge(sheet, folder=folder, force=True, progress=False)
    assert isinstance(sf.open(folder), sf.Convergence)
    # Without what meshes found it is the folder of any study, of which files are missing.
    for name in ("convergence.json", "convergence.txt"):
        (folder / name).unlink()
    with pytest.raises(sf.FolderError, match="convergence.json is missing"):
        sf.open(folder)
    assert type(sf.open(folder, verify=False)) is sf.StudyResults


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_ends_it_and_it_goes_on(sheet: Path, tmp_path: Path) -> None:
    folder = tmp_path / "meshes"
    case = sf.Case.load(sheet, {"slider.blocks": [40, 40]})

    def press(done: int, total: int, _: int) -> None:
        assert done < total
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        sf.converge(case, folder=folder, replicates=4, progress=press)
    before = (folder / "runs.jsonl").read_text().splitlines()
    assert 0 < len(before) < 24 and not (folder / "convergence.json").exists()
    seen: list[tuple[int, int, int]] = []
    found = sf.converge(case, folder=folder, replicates=4, progress=lambda *now: seen.append(now))
    assert len(found.runs) == 24 and seen[-1] == (24, 24, 0)
    # Runs that were recorded are not run again.
    assert (folder / "runs.jsonl").read_text().splitlines()[: len(before)] == before


@pytest.mark.parametrize(
    ("overrides", "options", "refused", "said"),
    [
        ({}, {"levels": 2}, sf.CaseError, "2 meshes are not possible: give 3 to 7 levels"),
        ({}, {"levels": 8}, sf.CaseError, "8 meshes are not possible: give 3 to 7 levels"),
        ({}, {"replicates": 0}, sf.CaseError, "`replicates` = 0 must lie between 1 and"),
        ({}, {"threads": 0}, ValueError, "threads are counted from 1, not 0"),
        ({}, {"max_memory": 0.001}, sf.CaseError, "more than `max_memory` 0.001;"),
        ({}, {"max_memory": float("nan")}, sf.CaseError, "more than `max_memory`"),
        ({}, {"max_time": "1ns"}, sf.CaseError, "longer than `max_time` 1ns:"),
        ({}, {"max_time": "soon"}, ValueError, '`max_time` = "soon" is not a time: give one such as "30min"'),
        ({"slider.blocks": [25, 25]}, {}, sf.CaseError, "cannot be divided"),
        ({"texture.0.coverage": 0.01}, {}, sf.CaseError, "no block is textured"),
        ({"drive.attach": "left"}, {}, sf.CaseError, "give `drive.total_stiffness`"),
    ],
)
def test_what_cannot_be_is_refused_before_a_folder_is_made(
    sheet: Path, tmp_path: Path, overrides: dict[str, Any], options: dict[str, Any], refused: type[Exception], said: str
) -> None:
    case = sf.Case.load(sheet, overrides)
    with pytest.raises(refused) as raised:
        sf.converge(case, folder=tmp_path / "meshes", progress=False, **options)
    assert said in str(raised.value) and "--" not in str(raised.value) and not (tmp_path / "meshes").exists()


def test_an_array_belongs_to_its_blocks_and_is_refused(small: sf.Case) -> None:
    mask = np.zeros(small.shape, dtype=bool)
    mask[2:6, 2:6] = True
    case = small.replace({"texture": [{"shape": "mask", "file": mask}]})
    with pytest.raises(sf.CaseError) as raised:
        sf.converge(case, progress=False)
    assert "has the shape (10, 12) where (5, 6), that is (ny, nx), is wanted" in str(raised.value)


def test_a_file_that_has_changed_is_refused(tmp_path: Path) -> None:
    picture = tmp_path / "herringbone.png"
    picture.write_bytes(Path("cases/herringbone.png").read_bytes())
    case = sf.Case.load("cases/mask.toml", {"texture.0.file": str(picture)})
    picture.write_bytes(picture.read_bytes() + b" ")
    with pytest.raises(sf.CaseError, match="has changed since the case was prepared: load the case again"):
        sf.converge(case, progress=False)


def test_a_folder_of_other_things_is_refused(sheet: Path) -> None:
    with pytest.raises(sf.FolderError, match="is not the folder of a study: choose another by `folder`"):
        sf.converge(sheet, folder=sheet.parent, progress=False)


def test_a_run_that_fails_is_told(tmp_path: Path, diverging: sf.Case) -> None:
    with pytest.raises(sf.RunError, match="of 3 runs failed; the tables contain the others. First failure, .* diverged"):
        sf.converge(diverging, folder=tmp_path / "meshes", replicates=1, progress=False)
    assert (tmp_path / "meshes" / "runs.csv").exists() and not (tmp_path / "meshes" / "convergence.json").exists()
