"""The command in the wheel with its licences, and runs of every case with its bits."""

import importlib.metadata
import os
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
