"""Runs: progress, interrupts, threads, results."""

import os
import pickle
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import slipfront as sf


def test_results_are_those_of_the_files(small: sf.Case, tmp_path: "os.PathLike[str]") -> None:
    xarray = pytest.importorskip("xarray")
    run = sf.run(small, progress=False)
    folder = run.save(os.path.join(tmp_path, "run"))
    assert run.folder == folder
    file = xarray.open_dataset(folder / "fields.nc", engine="scipy", decode_times=False)
    for name in ("time", "time_star", "x", "y", "textured", "mu_static", "mu_kinetic", "first_slip_time_star", "traction"):
        np.testing.assert_array_equal(run.fields[name].values, file[name].values)
        assert run.fields[name].attrs["units"] == file[name].attrs["units"], name
    assert [letter for letter in run.fields["instant"].values] == [word.decode().strip("\0 ") for word in file["instant"].values]
    kymograph = xarray.open_dataset(folder / "kymograph.nc", engine="scipy", decode_times=False)
    assert run.kymograph is not None
    np.testing.assert_array_equal(run.kymograph["sliding_share"].values, kymograph["sliding_share"].values)
    # A middle is computed from the ends.
    np.testing.assert_allclose(run.kymograph["place"].values, kymograph["place"].values, rtol=1e-12)
    table = np.genfromtxt(folder / "series.csv", delimiter=",", names=True)
    names = table.dtype.names or ()
    assert set(names) == set(run.series.variables)
    for name in names:
        np.testing.assert_array_equal(run.series[name].values, table[name])


def test_a_folder_gives_what_the_run_gave(small: sf.Case, tmp_path: "os.PathLike[str]") -> None:
    run = sf.run(small, progress=False)
    folder = run.save(os.path.join(tmp_path, "run"))
    opened = sf.open(folder)
    assert isinstance(opened, sf.Run)
    assert opened.summary == run.summary and opened.case.to_toml() == run.case.to_toml()
    assert opened.series.identical(run.series) and opened.fields.identical(run.fields)
    assert opened.kymograph is not None and run.kymograph is not None
    assert opened.kymograph["sliding_share"].equals(run.kymograph["sliding_share"])
    with pytest.raises(sf.FolderError):
        run.save(folder)
    again = opened.save(os.path.join(tmp_path, "copy"))
    assert (again / "manifest.json").read_bytes() == (folder / "manifest.json").read_bytes()
    summary = folder / "summary.json"
    summary.write_text(summary.read_text().replace("0", "1", 1))
    with pytest.raises(sf.FolderError, match="summary.json differs"):
        sf.open(folder)
    assert isinstance(sf.open(folder, verify=False), sf.Run)
    with pytest.raises(sf.FolderError, match="is not the folder of a run"):
        sf.open(tmp_path)


def test_a_run_that_was_opened_replaces_the_files_of_a_run_and_nothing_else(small: sf.Case, tmp_path: Path) -> None:
    sf.run(small, progress=False).save(tmp_path / "one")
    sf.run(small.replace({"drive.v_star": 0.05}), progress=False).save(tmp_path / "other")
    for name in ("one", "other"):
        (tmp_path / name / "notes.txt").write_text(name)
    one = sf.open(tmp_path / "one")
    assert isinstance(one, sf.Run)
    with pytest.raises(sf.FolderError, match="it is there already"):
        one.save(tmp_path / "one", force=True)
    with pytest.raises(sf.FolderError):
        one.save(tmp_path / "other")
    one.save(tmp_path / "other", force=True)
    assert (tmp_path / "other" / "notes.txt").read_text() == "other"
    assert (tmp_path / "other" / "manifest.json").read_bytes() == (tmp_path / "one" / "manifest.json").read_bytes()
    # Files that changed since it was read are not handed on as if they had not.
    (tmp_path / "one" / "series.csv").write_text("step\n")
    with pytest.raises(sf.FolderError, match="series.csv differs"):
        one.save(tmp_path / "third")
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "summary.json").write_text("mine")
    with pytest.raises(sf.FolderError):
        one.save(tmp_path / "foreign", force=True)
    assert (tmp_path / "foreign" / "summary.json").read_text() == "mine"


def test_edge_driven_runs_have_precursors() -> None:
    case = sf.Case.load("cases/edge_driven_chain.toml")
    run = sf.run(case, progress=False)
    assert run.precursors is not None
    assert len(run.precursors["length"]) == run.summary["precursors"]["events"] > 0


def test_runs_that_ask_for_events_have_a_catalogue() -> None:
    case = sf.Case({"slider": {"blocks": [4, 3]}, "drive": {"v_star": 0.2}, "output": {"events": True}})
    events = sf.run(case, progress=False).events
    assert events is not None and len(events["moment_star"]) > 0
    assert sf.run(case.replace({"output.events": False}), progress=False).events is None


def test_every_table_of_a_run_is_an_attribute() -> None:
    run = sf.run({"slider": {"blocks": [4, 3]}, "drive": {"v_star": 0.2}}, progress=False)
    assert all(hasattr(sf.Run, name) for name in run._tables)
    with pytest.raises(AttributeError):
        _ = run.precursor  # type: ignore[attr-defined]


def test_static_friction_without_a_transition_is_a_lower_bound() -> None:
    case = sf.Case({"slider": {"blocks": [8, 8]}, "drive": {"v_star": 0.1}})
    assert "mu_s* = 0" in repr(sf.run(case, progress=False))
    short = sf.run(case.replace({"time.duration_star": 20}), progress=False)
    assert not short.transition and "mu_s* = at least 0" in repr(short)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_ends_a_run_at_once(long: sf.Case) -> None:
    pressed: list[float] = []

    def press() -> None:
        pressed.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.5, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        sf.run(long, progress=False)
    # Slices of 50 ms. Time of the processor: that of the clock goes on while a busy machine does other work.
    assert time.process_time() - pressed[0] < 0.2
    timer.join()


def test_an_exception_in_progress_ends_a_run(long: sf.Case) -> None:
    seen: list[float] = []

    def watch(now: sf.Simulation) -> None:
        seen.append(now.time_star)
        if len(seen) == 3:
            raise ZeroDivisionError("enough")

    with pytest.raises(ZeroDivisionError, match="enough"):
        sf.run(long, progress=watch)
    assert seen == sorted(seen) and len(seen) == 3


def test_other_threads_go_on_and_give_the_same() -> None:
    case = sf.Case({"slider": {"blocks": [40, 40]}, "time": {"duration_star": 400}})
    alone = sf.run(case, progress=False, threads=1)
    found: list[sf.Run] = []
    threads = [threading.Thread(target=lambda: found.append(sf.run(case, progress=False, threads=1))) for _ in range(2)]
    for thread in threads:
        thread.start()
    # While they work this thread counts, which it could not if they held the lock.
    counted = 0
    while any(thread.is_alive() for thread in threads):
        counted += 1
        time.sleep(0.001)
    assert counted > 3 and len(found) == 2
    for run in found:
        assert run.summary == alone.summary and run.series.identical(alone.series)


def test_threads_do_not_change_bits() -> None:
    case = sf.Case({"slider": {"blocks": [200, 150]}, "time": {"duration_star": 20}, "drive": {"v_star": 0.1}})
    one, all_cores = (sf.run(case, progress=False, threads=threads) for threads in (1, None))
    assert one.summary == all_cores.summary and one.fields.identical(all_cores.fields)


def test_a_run_is_pickled_without_its_files(small: sf.Case, tmp_path: "os.PathLike[str]") -> None:
    run = sf.run(small, progress=False)
    twin = pickle.loads(pickle.dumps(run))
    assert twin.summary == run.summary and twin.fields.identical(run.fields)
    with pytest.raises(sf.FolderError, match="pickled"):
        twin.save(os.path.join(tmp_path, "twin"))


def test_pictures_are_drawn(small: sf.Case) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    run = sf.run(small, progress=False)
    for kind in ("friction", "front", "kymograph", "traction", "contact_stress_star"):
        axes = run.plot(kind)
        assert axes.get_xlabel()
        plt.close("all")
    figure, axes = plt.subplots()
    assert run.plot(ax=axes, label="mine") is axes and axes.get_legend() is not None
    plt.close(figure)
    with pytest.raises(ValueError, match='no field "velocity_x"'):
        run.plot("velocity_x")
    assert "mu_s*" in repr(run) and "mu_s*" in run._repr_html_()


def test_a_run_that_diverges_says_so(diverging: sf.Case) -> None:
    with pytest.raises(sf.RunError, match="at step .* diverged"):
        sf.run(diverging, progress=False)
