"""Calibrations in Python."""

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import slipfront as sf

SLIDER: dict[str, Any] = {"slider": {"blocks": [6, 6]}, "drive": {"v_star": 0.1}, "time": {"step": 0.4, "duration_star": 120}}
UNKNOWNS = {"friction.mu_static": (0.3, 0.9), "drive.stiffness_star": (0.3, 0.9)}


def calibration(**keys: Any) -> sf.Calibration:
    keys = {"runs": 200, "finer_runs": 0} | keys
    return sf.Calibration(SLIDER, unknowns=UNKNOWNS, noise=0.01, **keys)


def record(seed: int = 3) -> dict[str, np.ndarray[Any, np.dtype[np.float64]]]:
    """Friction of the slider, with noise."""
    case = sf.Case(SLIDER).replace({"friction.seed": seed, "drive.stiffness_star": 0.7, "output.series": 1})
    series = sf.run(case, progress=False).series
    force = np.asarray(series["friction_force_n"])
    noise = np.random.default_rng(seed).normal(0, 0.01 * force.mean(), len(force))
    return {"time_s": np.asarray(series["time_s"]), "force_n": force + noise}


def test_a_calibration_has_the_bytes_of_the_command(tmp_path: Path) -> None:
    shown: list[tuple[int, int]] = []
    measured = record()
    fit = calibration().fit(measured, folder=tmp_path / "one", progress=lambda *now: shown.append(now), threads=2)
    # The runs of the training, of the calibrated model and of half the step.
    assert shown and shown[-1] == (200 + 120 + 40, 360)
    (tmp_path / "fit.toml").write_bytes((tmp_path / "one/calibration.toml").read_bytes())
    command = [sys.executable, "-m", "slipfront", "calibrate", "fit.toml", "one/record-1.csv", "-o", "two", "--quiet", "--threads", "1"]
    subprocess.run(command, cwd=tmp_path, check=True)
    for name in ("calibration.json", "posterior.csv", "band-1.csv", "band-1.png", "case.toml", "record-1.csv"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes(), name
    assert fit.to_dict() == json.loads((tmp_path / "two/calibration.json").read_text())
    stiffness = fit.intervals["drive.stiffness_star"]
    assert stiffness.low < 0.7 < stiffness.high and stiffness.low < stiffness.median < stiffness.high
    assert fit.case["drive.stiffness_star"] == stiffness.median
    assert "drive.stiffness_star" not in fit.undetermined and not fit.is_refused
    assert fit.misfit["distance"] < 1 and fit.pairs == []
    assert fit.posterior["drive.stiffness_star"].shape == (400,)
    opened = sf.open(tmp_path / "one")
    assert isinstance(opened, sf.CalibrationResults) and opened.to_dict() == fit.to_dict()
    (tmp_path / "two/case.toml").write_text((tmp_path / "two/case.toml").read_text() + "\n")
    with pytest.raises(sf.FolderError, match=r"case\.toml differs"):
        sf.open(tmp_path / "two")


def test_what_promises_nothing_has_a_warning(tmp_path: Path) -> None:
    made, measured = calibration(), record()
    with pytest.warns(UserWarning, match="the model cannot reproduce these records"):
        foreign = made.fit({**measured, "force_n": 100 * measured["force_n"]}, progress=False)
    assert foreign.is_refused
    path = tmp_path / "ended.csv"
    rows = zip(measured["time_s"].tolist(), measured["force_n"].tolist(), strict=True)
    path.write_text("time_s,force_n\n" + "".join(f"{time},{force}\n" for time, force in rows) + "End of test\n")
    with pytest.warns(UserWarning, match=r"ended\.csv ends with 1 line without numbers"):
        made.fit(path, progress=False)


def test_records_in_memory_share_their_runs() -> None:
    made = calibration()
    first = made.fit(record(), progress=False)
    shown: list[tuple[int, int]] = []
    again = made.fit(record(), progress=lambda *now: shown.append(now))
    assert again.to_dict() == first.to_dict()
    # None of the training.
    assert shown[-1] == (120 + 40, 160)
    with pytest.raises(LookupError, match="in memory"):
        _ = again.case
    copied = pickle.loads(pickle.dumps(again))
    assert repr(copied) == repr(again) and copied.intervals == again.intervals


def test_what_is_wrong_is_said(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="path of a calibration file alone"):
        sf.Calibration(SLIDER, unknowns=UNKNOWNS)
    with pytest.raises(sf.CaseError, match="noise"):
        sf.Calibration(SLIDER, unknowns=UNKNOWNS, noise=2)
    with pytest.raises(sf.CaseError, match="did you mean `runs`"):
        calibration(rums=3)
    with pytest.raises(sf.CaseError, match="has no column `force_n`"):
        calibration().fit({"time_s": [1, 2, 3]})
    with pytest.raises(sf.CaseError, match="has 3 values"):
        calibration().fit({"time_s": [1, 2, 3], "force_n": [1, 2, 3]})
    with pytest.raises(sf.CaseError, match="unknown key"):
        sf.Calibration(SLIDER, unknowns={"friction.mu_sttic": (0.3, 0.9)}, noise=0.01).fit(record())
    with pytest.raises(sf.CaseError, match="drive"):
        calibration(next=[{"drive": {"v_star": -1}}]).fit(record(), folder=tmp_path / "found")


def test_records_are_tables_arrays_and_frames() -> None:
    made, measured = calibration(), record()
    fit = made.fit(measured, progress=False)
    frame = pd.DataFrame({"n": range(len(measured["time_s"])), "Zeit [ns]": 1e9 * measured["time_s"], "Kraft in mN": 1e3 * measured["force_n"]})
    by_name = calibration(x="Zeit", y="Kraft").fit(frame, progress=False)
    by_place = made.fit((measured["time_s"], measured["force_n"]), progress=False)
    assert by_place.to_dict() == fit.to_dict()
    for key, interval in by_name.intervals.items():
        # Times and forces are rounded by their units.
        assert interval.median == pytest.approx(fit.intervals[key].median, rel=1e-6)


def test_errors_name_no_hidden_file() -> None:
    measured = record()
    with pytest.raises(sf.CaseError, match="record 1 has no column `force_n`") as error:
        calibration().fit({"time_s": measured["time_s"], "load_n": measured["force_n"]}, progress=False)
    assert "tmp" not in str(error.value) and ".csv" not in str(error.value)
    with pytest.raises(ValueError, match="must have the same length"):
        calibration().fit({"time_s": measured["time_s"], "force_n": measured["force_n"][1:]}, progress=False)
    with pytest.warns(UserWarning) as told:
        calibration().fit({**measured, "force_n": -measured["force_n"]}, progress=False)
    assert any("the mean friction of record 1 is negative: `y_factor = -1`" in str(one.message) for one in told)


def test_results_are_a_table_and_a_picture(tmp_path: Path) -> None:
    fit = calibration().fit(record(), progress=False)
    table = fit.unknowns.set_index("key")
    assert list(table.columns) == ["median", "low", "high", "unit", "is_determined", "belongs_to_block", "depends_on_step"]
    for key, interval in fit.intervals.items():
        row = table.loc[key]
        assert (row["median"], row["low"], row["high"]) == (interval.median, interval.low, interval.high)
    assert table["is_determined"].all() and not table["belongs_to_block"].any()
    # Nothing of the picture is in a folder that is gone, and a pickle has it too.
    for results in (fit, pickle.loads(pickle.dumps(fit))):
        ax = results.plot()
        assert (ax.get_xlabel(), ax.get_ylabel()) == ("time (ns)", "friction force (\u00b5N)")
        median, drawn = (np.asarray(line.get_ydata()) for line in ax.get_lines())
        (band,) = ax.collections
        low, high = (end(np.asarray(band.get_paths()[0].vertices)[:, 1]) for end in (np.min, np.max))
        assert low < median.min() and median.max() < high and len(drawn) == len(median)
        same = ax.figure.subplots()
        assert results.plot(1, same) is same
        plt.close("all")
    with pytest.raises(ValueError, match="there is no record 2: the records of this calibration are 1 to 1"):
        fit.plot(2)


def test_a_record_is_checked_alone() -> None:
    made, measured = calibration(next=[{"drive": {"v_star": 0.05}}]), record()
    check = made.check(measured, progress=False)
    assert not check.is_refused and check.reasons == []
    shown: list[tuple[int, int]] = []
    assert made.check(measured, progress=lambda *now: shown.append(now)) == check
    # Those of the calibrated model alone are made again.
    assert shown[-1] == (120, 120)
    # Of the trainings that of the next experiment alone is left.
    fit = made.fit(measured, progress=lambda *now: shown.append(now))
    assert shown[-1] == (200 + 120 + 40, 360)
    assert (check.misfit, check.comparison, check.closest) == (fit.misfit, fit.comparison, fit.closest)
    assert check.clipped is None and fit.clipped is None
    force = measured["force_n"]
    clipped = made.check({**measured, "force_n": np.minimum(force, np.quantile(force, 0.9))}, progress=False)
    assert clipped.clipped is not None and any("saturated" in reason for reason in clipped.reasons)
    assert 0 <= check.comparison["rank"] <= 1
    foreign = made.check({**measured, "force_n": 100 * measured["force_n"]}, progress=False)
    assert foreign.is_refused and any("of the training runs" in reason for reason in foreign.reasons)


def test_what_a_record_would_show_is_known_before_it_is_measured(tmp_path: Path) -> None:
    made, measured = calibration(), record()
    plan = made.plan(until="40 ns", progress=False)
    planned = plan["as planned"]
    assert isinstance(planned, dict) and list(planned) == list(UNKNOWNS)
    assert all(0 < width < 0.1 for width in planned.values())
    assert {"twice as long", "a third of the speed", "three times the speed"} < set(plan)
    # Of a record the times alone count.
    other = made.plan({**measured, "force_n": measured["force_n"] + 1}, progress=False)
    assert other == made.plan(measured, progress=False)
    # Runs that are kept are made once.
    shown: list[tuple[int, int]] = []
    made.check(measured, training=tmp_path / "kept", progress=False)
    calibration().check(measured, training=tmp_path / "kept", progress=lambda *now: shown.append(now))
    assert shown[-1] == (120, 120)
    with pytest.raises(ValueError, match="give either records or `until`"):
        made.plan(progress=False)
    with pytest.raises(sf.CaseError, match="give a time"):
        made.plan(until="2 um", progress=False)


def test_an_instrument_stands_before_the_record(tmp_path: Path) -> None:
    measured = record()
    plain = calibration().fit(measured, progress=False)
    doubled = {**measured, "force_n": 2 * measured["force_n"]}
    fit = calibration(instrument={"gain": 2, "range": ["-1 N", "1 N"]}).fit(doubled, folder=tmp_path / "doubled", progress=False)
    assert "[instrument]\ngain = 2\nrange = " in (tmp_path / "doubled/calibration.toml").read_text()
    for key, interval in plain.intervals.items():
        # What is twice as large in all runs is the same to the estimate, but for rounding.
        assert fit.intervals[key].median == pytest.approx(interval.median, rel=1e-6)
    unknowns = {"instrument.gain": (1, 3), "drive.stiffness_star": (0.3, 0.9)}
    case = {**SLIDER, "friction": {"sigma_static_star": 0, "sigma_kinetic_star": 0}}
    gain = sf.Calibration(case, unknowns=unknowns, noise=0.01, runs=200, finer_runs=0, instrument={"offset": "0 N"})
    series = sf.run(sf.Case(case).replace({"drive.stiffness_star": 0.7, "time.step": 0.0125, "output.series": 1}), progress=False).series
    force = 2 * np.asarray(series["friction_force_n"])
    force += np.random.default_rng(5).normal(0, 0.01 * force.mean(), len(force))
    found = gain.fit((series["time_s"], force), progress=False)
    interval = found.intervals["instrument.gain"]
    assert interval.is_determined and interval.median == pytest.approx(2, rel=0.05)
    # Without random coefficients the same keys always make the same curve.
    assert found.closest is not None and found.closest["noise_ratio"] > 0
    with pytest.raises(sf.CaseError, match="unknown key `cuttoff` in the table .instrument.: did you mean `cutoff`"):
        calibration(instrument={"cuttoff": "20 Hz"})
    with pytest.raises(ValueError, match="path of a calibration file alone"):
        sf.Calibration("fit.toml", instrument={"gain": 2})
