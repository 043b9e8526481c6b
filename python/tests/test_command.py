"""The command in the wheel with its licences, and runs of every case with its bits."""

import importlib.metadata
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import slipfront as sf

from .conftest import CASES


def command(*arguments: str | os.PathLike[str]) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, "-m", "slipfront", *arguments], capture_output=True, text=True, check=False)


def test_the_command_has_its_version_and_status() -> None:
    assert command("--version").stdout.startswith(f"slipfront {sf.__version__}\nbuild ")
    refused = command("run", "cases/cirle.toml")
    assert refused.returncode == 2 and "did you mean" in refused.stderr


def test_the_laboratory_takes_its_module_from_the_package(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    ended = command("lab", "--single", page)
    # Wheels of a release have it, and others say where it was looked for.
    if Path(sf.__file__).with_name("slipfront.wasm").exists():
        assert ended.returncode == 0 and "slipfront.wasm" in page.read_text()
    else:
        assert ended.returncode == 2 and "slipfront.wasm, is not in" in " ".join(ended.stderr.split())


def test_the_wheel_carries_the_licences_of_what_it_contains() -> None:
    distribution = importlib.metadata.distribution("slipfront")
    shipped = distribution.read_text("licenses/THIRD-PARTY-NOTICES.txt")
    assert shipped is not None and shipped == command("licences").stdout
    assert distribution.metadata.get_all("License-File") == ["THIRD-PARTY-NOTICES.txt"]
    for words in ["Copyright (c) The slipfront developers", "Bitstream Vera", "uPlot", "\nrayon 1.", "\npyo3 0.", "\nnumpy 0."]:
        assert words in shipped


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_every_case_gives_the_bytes_of_the_command(path: Path, tmp_path: Path) -> None:
    ran = command("run", path, "-o", tmp_path / "command", "--quiet")
    assert ran.returncode == 0, ran.stderr
    saved = sf.run(path, progress=False).save(tmp_path / "python")
    names = [sorted(str(file.relative_to(folder)) for file in folder.rglob("*")) for folder in (tmp_path / "command", saved)]
    assert names[0] == names[1] and "fields.nc" in names[0]
    for name in names[0]:
        ours = saved / name
        # The manifest tells when and by whom.
        if ours.is_file() and name != "manifest.json":
            assert ours.read_bytes() == (tmp_path / "command" / name).read_bytes(), name


def test_an_interrupted_run_of_the_command_goes_on(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    started = subprocess.Popen(
        [sys.executable, "-m", "slipfront", "run", "cases/circle.toml", "--set", "time.duration_star=20000", "-o", folder, "--quiet"]
    )
    while not (folder / "case.toml").exists():
        assert started.poll() is None
    # It stops with a checkpoint.
    started.terminate()
    assert started.wait() == 143
    opened = sf.open(folder)
    assert isinstance(opened, sf.InterruptedRun)
    whole = sf.Simulation(opened.case)
    whole.step(opened.simulation.steps + 500)
    opened.simulation.step(500)
    assert (whole.displacement == opened.simulation.displacement).all()


def test_runs_are_exported_with_the_bytes_of_the_command(small: sf.Case, tmp_path: Path) -> None:
    run = sf.run(small, progress=False)
    with pytest.raises(sf.FolderError, match="save it first"):
        sf.export(run, "bibtex")
    folder, twin = run.save(tmp_path / "run"), tmp_path / "twin" / "run"
    shutil.copytree(folder, twin)
    told = ("--author", "NAME", "--licence", "CC-BY-4.0")
    assert sf.export(run, "bibtex") == command("export", folder, "--bibtex").stdout
    assert sf.export([folder, str(twin)], "cff", author="NAME", licence="CC-BY-4.0") == command("export", folder, twin, "--cff", *told).stdout
    # The description has the date, which may change between both.
    for _ in range(2):
        path = sf.export(run, "ro-crate", author="NAME", licence="CC-BY-4.0", force=True)
        assert command("export", twin, "--ro-crate", *told, "--force").returncode == 0
        if path.read_bytes() == (twin / "ro-crate-metadata.json").read_bytes():
            break
    else:
        pytest.fail("the descriptions differ")
    copies = sf.export(run, "ro-crate", author="NAME", licence="CC-BY-4.0", folder=tmp_path / "crate")
    assert copies == tmp_path / "crate" / "ro-crate-metadata.json" and (tmp_path / "crate/run/summary.json").exists()


def test_a_study_is_exported_by_its_folder(small: sf.Case, tmp_path: Path) -> None:
    study = sf.Study(small, axes={"drive.v_star": [0.1, 0.2]})
    folder = study.run(tmp_path / "first", progress=False).folder
    assert folder is not None
    assert "first (study from 2 recorded runs)" in sf.export(folder, "bibtex")
    assert sf.export(folder, "bibtex") == command("export", folder, "--bibtex").stdout


def test_an_export_that_cannot_be_is_refused_in_the_words_of_python(small: sf.Case, tmp_path: Path) -> None:
    run = sf.run(small, progress=False)
    folder = run.save(tmp_path / "run")
    with pytest.warns(UserWarning, match="add `(author|licence)`") as warned:
        sf.export(run, "ro-crate")
    assert len(warned) == 2 and all(warning.filename == __file__ for warning in warned)
    with pytest.raises(sf.FolderError, match="replace it by `force=True`, or write the crate to a new folder by `folder`"):
        sf.export(run, "ro-crate")
    with pytest.raises(ValueError, match="give its folder by `folder`"):
        sf.export([run, run], "ro-crate")
    with pytest.raises(ValueError, match="add `author`"):
        sf.export(run, "cff")
    with pytest.raises(ValueError, match='licence = "CC BY": write an identifier'):
        sf.export(run, "bibtex", licence="CC BY")
    with pytest.raises(ValueError, match="give one of them"):
        sf.export(run, "ro-crate", folder=tmp_path / "crate", force=True)
    with pytest.raises(ValueError, match='"ro-crate", "bibtex" or "cff"'):
        sf.export(run, "apa")  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="gives a text"):
        sf.export(run, "bibtex", force=True)  # type: ignore[call-overload]
    (folder / "series.csv").write_text("step\n")
    with pytest.raises(sf.FolderError, match="series.csv differs"):
        sf.export(run, "bibtex")
