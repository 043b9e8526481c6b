"""Studies."""

import math
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipfront as sf

pandas = pytest.importorskip("pandas")


@pytest.fixture
def study(small: sf.Case) -> sf.Study:
    return sf.Study(small.replace({"slider.blocks": [8, 8]}), axes={"drive.v_star": [0.02, 0.05]}, replicates=3)


def test_points_are_those_of_the_runs(study: sf.Study) -> None:
    results = study.run(progress=False)
    assert len(results.runs) == 6 and results.failures == [] and results.folder is None
    assert results.anisotropy is None
    runs = results.runs
    for point, replicate, found in zip(runs["point"], runs["replicate"], runs["static_friction_star"], strict=True):
        alone = sf.run(study.case(int(point), int(replicate)), progress=False)
        assert alone.static_friction_star == found
    means = results.points.query("quantity == 'static_friction_star'")["mean"].tolist()
    by_point = results.runs.groupby("point")["static_friction_star"].mean().tolist()
    # Two ways to add three numbers.
    assert all(math.isclose(a, b, rel_tol=1e-14) for a, b in zip(means, by_point, strict=True))


def test_a_folder_is_that_of_the_command_and_goes_on(study: sf.Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    seen: list[tuple[int, int, int]] = []
    first = study.run(folder, progress=lambda *now: seen.append(now))
    assert seen and seen[-1][2] == 0
    again = study.run(folder, progress=False)
    assert again.runs.equals(first.runs)
    assert (folder / "points.csv").exists() and (folder / "study.toml").exists()
    opened = sf.open(folder)
    assert isinstance(opened, sf.StudyResults) and opened.points.equals(first.points)
    assert sf.open_study(folder).points.equals(first.points)
    with pytest.raises(sf.FolderError, match=r"not the folder of a complete run but holds StudyResults\(6 runs"):
        sf.open_run(folder)


def test_means_are_drawn_over_an_axis(small: sf.Case) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    axes: dict[str, Any] = {"drive.v_star": [0.02, 0.05, 0.1], "shape": {"plain": {}, "groove": {"texture": [{"shape": "groove", "coverage": 10}]}}}
    results = sf.Study(small, axes=axes, replicates=2).run(progress=False)
    over_speed, over_shape = results.plot("sliding_percent_max"), results.plot("sliding_percent_max", over="shape")
    assert (over_speed.get_xlabel(), over_speed.get_ylabel()) == ("drive speed V*", "sliding_percent_max")
    legend = over_shape.get_legend()
    assert legend is not None and legend.get_title().get_text() == "V*"
    assert [text.get_text() for text in legend.get_texts()] == ["0.02", "0.05", "0.1"]
    assert [len(drawn.containers) for drawn in (over_speed, over_shape)] == [2, 3]
    points = results.points.query("quantity == 'sliding_percent_max' and shape == 'groove'")
    # Each curve is the first of the lines of its error bars.
    curves = [drawn for drawn in over_speed.lines if drawn.get_linestyle() == "-"]
    assert len(curves) == 2
    line = curves[1]
    assert np.array_equal(line.get_xdata(), axes["drive.v_star"]) and np.array_equal(line.get_ydata(), points["mean"])
    assert results.plot("steps", ax=over_speed) is over_speed
    plt.close("all")
    with pytest.raises(ValueError, match='no quantity "speed": it has "static_friction_star"'):
        results.plot("speed")
    with pytest.raises(ValueError, match='no axis "drive.direction": it has drive.v_star, shape'):
        results.plot(over="drive.direction")
    with pytest.raises(ValueError, match="a study without an axis has one point"):
        sf.Study(small, replicates=1).run(progress=False).plot("steps")


def test_own_quantities_are_columns_and_found_again(study: sf.Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    study.run(folder, progress=False)
    own = {"last": lambda run: run.series["mu_star"].values[-1], "steps_twice": lambda run: 2 * run.steps}
    late = study.run(folder, progress=False, quantities=own).runs
    fresh = study.run(progress=False, quantities=own).runs
    assert late.equals(fresh)
    points = study.run(progress=False, quantities=own).points
    # Of twice the steps everything is twice that of the steps, to the bit.
    twice, once = (points[points["quantity"] == name] for name in ("steps_twice", "steps"))
    for column in ("mean", "deviation", "low", "high", "min", "max"):
        assert (twice[column].to_numpy() == 2 * once[column].to_numpy()).all(), column
    assert (twice["n"] == 3).all() and twice["drive.v_star"].tolist() == [0.02, 0.05]
    assert (fresh["steps_twice"] == 2 * fresh["steps"]).all() and fresh["last"].notna().all()


def test_points_levels_and_names_that_are_none_are_told(study: sf.Study, small: sf.Case) -> None:
    for point, replicate in ((2, 0), (-1, 0), (0, -1)):
        with pytest.raises(IndexError, match="counted from 0"):
            study.case(point, replicate)
    for name in ("steps", "point", "status", "mean", "drive.v_star"):
        with pytest.raises(ValueError, match=f"column `{name}` already: give the quantity another name"):
            study.run(progress=False, quantities={name: lambda run: 1.0})
    for levels in (0.1, "1 mm/s"):
        with pytest.raises(TypeError, match="are a list, such as"):
            sf.Study(small, axes={"drive.speed": levels})  # type: ignore[dict-item]


def test_coverages_stand_as_they_are_meshed(small: sf.Case) -> None:
    """Coverages are drawn as they are meshed: of 25 columns, 5 % are one and 15 % are three."""
    case = small.replace({"slider.blocks": [25, 4], "texture": [{"shape": "groove", "coverage": 5}]})
    study = sf.Study(case, axes={"texture.0.coverage": [5, 15]}, replicates=2)
    points = study.run(progress=False, quantities={"twice": lambda run: 2 * run.steps}).points
    assert {(row["texture.0.coverage"], row["texture_percent"]) for _, row in points.iterrows()} == {(5, 4), (15, 12)}


def test_blocks_that_are_too_coarse_are_told_once(small: sf.Case) -> None:
    case = small.replace({"slider.blocks": [25, 25], "texture": [{"shape": "groove", "coverage": 5}]})
    (coarse,) = [sentence for sentence in case.warnings if "the outline needs" in sentence]
    assert "the smallest groove is 1.25 blocks across; the outline needs 5, at least 100 x 100 blocks" in coarse
    told = sf.Study(case, axes={"texture.0.coverage": [5, 6]}).warnings
    (sentence,) = [sentence for sentence in told if "the outline needs" in sentence]
    assert sentence == f"{coarse} (at 2 points, the first texture.0.coverage = 5)"


def test_a_study_without_an_answer_has_a_warning(small: sf.Case) -> None:
    short = small.replace({"time.duration_star": 5})
    with pytest.warns(UserWarning, match="no run has a value of static_friction_star, because none has a transition"):
        results = sf.Study(short, axes={"drive.v_star": [0.05, 0.1]}).run(progress=False)
    assert len(results.runs) == 2


def test_an_axis_may_have_named_variants(small: sf.Case) -> None:
    mask = np.zeros(small.shape, dtype=bool)
    mask[3:6, 3:6] = True
    variants = {"plain": {}, "dimple": {"texture": [{"shape": "mask", "file": mask}]}}
    runs = sf.Study(small, axes={"texture": variants}).run(progress=False).runs
    assert runs["texture"].tolist() == ["plain", "dimple"]
    assert runs["texture_percent"].tolist() == [0, 7.5]


def test_an_exception_of_an_own_quantity_ends_the_study_and_fails_no_run(study: sf.Study, tmp_path: Path) -> None:
    folder = tmp_path / "study"
    with pytest.raises(ZeroDivisionError):
        study.run(folder, progress=False, quantities={"wrong": lambda run: 1 / 0})
    assert study.run(folder, progress=False).failures == []


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_ends_a_study_which_goes_on(small: sf.Case, tmp_path: Path) -> None:
    speeds = [0.01 + 0.001 * k for k in range(20)]
    study = sf.Study(small.replace({"slider.blocks": [100, 100]}), axes={"drive.v_star": speeds}, replicates=2)

    def press(done: int, total: int, _: int) -> None:
        assert done < total
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        study.run(tmp_path / "study", progress=press)
    records = (tmp_path / "study" / "runs.jsonl").read_text().splitlines()
    assert 0 < len(records) < 40
    assert len(study.run(tmp_path / "study", progress=False).runs) == 40


def test_a_study_file_is_run(tmp_path: Path) -> None:
    text = 'base = "%s"\n[study]\nreplicates = 1\n[[axes]]\nkey = "drive.v_star"\nlist = [0.05, 0.1]\n'
    path = tmp_path / "mine.toml"
    path.write_text(text % Path("cases/chain.toml").absolute())
    assert len(sf.Study(path).run(progress=False).runs) == 2
    path.write_text(text.replace("v_star", "v_start") % Path("cases/chain.toml").absolute())
    with pytest.raises(sf.CaseError, match="v_star"):
        sf.Study(path)


def test_the_folder_of_the_paper_is_tables(tmp_path: Path) -> None:
    """As `slipfront paper` leaves it: what was found, claims, and a table beside each picture."""
    (tmp_path / "found").mkdir()
    with pytest.raises(sf.FolderError, match="a paper that is finished"):
        sf.open(tmp_path)
    (tmp_path / "claims.csv").write_text("number,claim,value\n1,it slips,0.69\n")
    (tmp_path / "fig03.png").write_bytes(b"")
    (tmp_path / "fig03.csv").write_text("t,mu\n0,0\n1,0.5\n")
    with pytest.raises(sf.FolderError, match="checksums.json is missing"):
        sf.open(tmp_path)
    paper = sf.open(tmp_path, verify=False)
    assert isinstance(paper, sf.PaperResults)
    assert paper.claims["value"].tolist() == [0.69]
    assert list(paper.figures) == ["fig03"] and paper.figures["fig03"]["mu"].tolist() == [0, 0.5]
