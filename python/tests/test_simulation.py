"""Runs taken step by step."""

import copy
import math
import pickle
import threading
from typing import Any

import numpy as np
import pytest

import slipfront as sf


def test_steps_add_up_to_the_run(small: sf.Case) -> None:
    whole = sf.run(small, progress=False)
    simulation = sf.Simulation(small)
    seen: list[tuple[int, float]] = []
    assert not simulation.run_until(every=7, observer=lambda now: seen.append((now.steps, now.mu_star)))
    assert simulation.ended and simulation.steps == whole.steps
    assert [step for step, _ in seen[:3]] == [0, 7, 14] and seen[-1][0] == whole.steps
    by_step = dict(zip(whole.series["step"].values.tolist(), whole.series["mu_star"].values.tolist(), strict=True))
    assert all(by_step[step] == mu_star for step, mu_star in seen if step in by_step)
    assert simulation.step(10) == 0
    assert simulation.series.identical(whole.series)
    assert simulation.run(progress=False).summary == whole.summary
    with pytest.raises(RuntimeError, match="given its results away"):
        simulation.step()


def test_a_field_is_that_of_the_files(small: sf.Case) -> None:
    whole = sf.run(small, progress=False)
    index = 2
    simulation = sf.Simulation(small)
    simulation.step(int(whole.fields["step"].values[index]))
    for name in ("traction", "displacement_x", "displacement_y"):
        np.testing.assert_array_equal(simulation.field(name), whole.fields[name].values[index])
    # A field is rounded to 24 bits before and after it gets its unit.
    np.testing.assert_allclose(simulation.displacement[0], simulation.field("displacement_x"), rtol=2**-23)
    with pytest.raises(ValueError, match="no field `speed`"):
        simulation.field("speed")


@pytest.mark.parametrize("path", ["circle", "rate_and_state", "contact_springs", "edge_driven_chain", "slide_hold_slide"])
def test_copies_go_on_with_the_same_bits(path: str) -> None:
    case = sf.Case.load(f"cases/{path}.toml")
    simulation = sf.Simulation(case)
    simulation.step(case.last_step // 2)
    twins = [copy.copy(simulation), copy.deepcopy(simulation), pickle.loads(pickle.dumps(simulation))]
    twins.append(sf.Simulation.resume(case, simulation.checkpoint()))
    expected = simulation.run(progress=False)
    for twin in twins:
        found = twin.run(progress=False)
        assert found.summary == expected.summary and found.fields.identical(expected.fields)
        assert found.series.identical(expected.series)


@pytest.mark.parametrize("stop", ["end", "after_onset"])
def test_a_simulation_is_copied_at_any_step_from_the_first_to_the_end(small: sf.Case, stop: str) -> None:
    # The last step is not one at which the curve has a row anyway.
    case = small.replace({"output.series": 1.1, "time.stop": stop})
    expected = sf.run(case, progress=False)
    assert expected.steps % 11 != 0
    for steps in (0, 1, 11, expected.steps - 1, expected.steps, expected.steps + 1):
        simulation = sf.Simulation(case)
        simulation.step(steps)
        found = pickle.loads(pickle.dumps(simulation)).run(progress=False)
        assert found.summary == expected.summary and found.series.identical(expected.series), steps


def test_what_is_no_number_of_steps_or_time_is_refused(small: sf.Case) -> None:
    simulation = sf.Simulation(small)
    for steps in (2.5, math.nan, "3"):
        with pytest.raises(TypeError):
            simulation.step(steps)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="not NaN"):
        simulation.run_until(time_star=math.nan)
    assert simulation.step(np.int64(3)) == simulation.steps == 3  # type: ignore[arg-type]
    # Written to, they would stay what they are in the run.
    for array in (simulation.displacement, simulation.velocity):
        with pytest.raises(ValueError, match="read-only"):
            array += 1


def test_a_checkpoint_of_another_case_is_refused(small: sf.Case) -> None:
    checkpoint = sf.Simulation(small).checkpoint()
    other = sf.Case.load("cases/circle.toml")
    for bytes_ in (checkpoint, checkpoint[:-1], b"", b"nothing at all"):
        with pytest.raises(ValueError, match="no checkpoint of a run of this case"):
            sf.Simulation.resume(other, bytes_)


def test_a_second_thread_is_told_to_wait(long: sf.Case) -> None:
    simulation = sf.Simulation(long)
    thread = threading.Thread(target=simulation.step, args=(20_000,))
    thread.start()
    refused = 0
    while thread.is_alive():
        try:
            simulation.step()
        except RuntimeError as error:
            assert "another thread is using this simulation" in str(error)
            refused += 1
    assert refused > 0
    thread.join()


def test_a_change_keeps_where_blocks_are_and_how_fast() -> None:
    case = sf.Case.load("cases/circle.toml")
    simulation = sf.Simulation(case)
    simulation.run_until(time_star=60)
    before, velocity, steps = simulation.displacement, simulation.velocity, simulation.steps
    dt = case.numbers["dt_star"] * case.numbers["time_unit_s"]
    simulation.change({"drive.v_star": 0.02, "load.pressure": "60 kPa"})
    # The step that was begun is taken to its end. Displacements are turned into units of the case and back:
    # some roundings.
    moved = before + dt * velocity
    scale = np.abs(moved).max()
    np.testing.assert_allclose(simulation.displacement, moved, rtol=0, atol=1e-13 * scale)
    assert simulation.steps == steps + 1
    # The sum of the steps of the legs, each in the unit of its case.
    assert simulation.time_star == (steps + 1) * case.numbers["dt_star"]
    assert simulation.time_s == pytest.approx((steps + 1) * dt, rel=1e-12)
    assert [taken for _, taken in simulation.recipe()] == [steps + 1, 0]
    simulation.step(5)
    last = simulation.series.isel(time_star=-1)
    assert last["step"] == simulation.steps == steps + 6
    assert last["time_s"] == pytest.approx(simulation.time_s, rel=1e-12) and last["time_star"] == pytest.approx(simulation.time_star, rel=1e-12)
    with pytest.raises(ValueError, match="has passed"):
        simulation.run_until(time_star=0.1)
    with pytest.raises(RuntimeError, match="no results of one case"):
        simulation.run(progress=False)


def test_a_change_to_the_same_case_goes_on_as_before() -> None:
    """The drive begins where it stood: friction goes on without a jump, and so do displacements."""
    case = sf.Case.load("cases/circle.toml")
    plain, changed = sf.Simulation(case), sf.Simulation(case)
    plain.step(1000)
    changed.step(999)
    changed.change({})
    assert changed.steps == plain.steps == 1000
    # Rounding of the displacements relative to the drive, which moves on by more than the blocks do.
    assert changed.mu_star == pytest.approx(plain.mu_star, rel=1e-9)
    for simulation in (changed, plain):
        simulation.step(200)
    assert changed.mu_star == pytest.approx(plain.mu_star, rel=1e-6)
    np.testing.assert_allclose(changed.displacement, plain.displacement, atol=1e-6 * np.abs(plain.displacement).max())


@pytest.mark.parametrize("more", [{}, {"slider.viscosity_time_star": 0.1}, {"drive.loading": "held"}])
def test_every_column_goes_on_after_a_change(more: dict[str, Any]) -> None:
    """A run that is changed to the same case, also after its end, has the columns of one that is not: work and losses add up."""
    changes = {"output.series": 0.1, "drive.v_star": 0.1, **more}
    case = sf.Case.load("cases/circle.toml", changes)
    plain, changed = sf.Simulation(case), sf.Simulation(case, {"time.duration_star": 40})
    while changed.step(10_000):
        pass
    assert changed.ended
    changed.change({})
    changed.step(150)
    changed.change({"time.duration_star": 100})
    changed.step(150)
    plain.step(changed.steps)
    found, wanted = changed.series, plain.series
    # A held drive that stands has no rows, but each leg has one where it begins.
    found = found.isel(time_star=np.isin(found["step"], wanted["step"]))
    assert list(found) == list(wanted) and len(changed.series["step"]) - len(found["step"]) in (0, 2)
    assert found["friction_loss_j"].values[-1] > 0.1 * found["work_j"].values[-1] > 0
    for name in (*found.coords, *found):
        values = wanted[name].values
        # Rounding of the displacements relative to the drive, which moves on by more than the blocks do.
        np.testing.assert_allclose(found[name].values, values, rtol=0, atol=1e-6 * np.abs(values).max(), err_msg=str(name))
    for name in ("displacement_x", "displacement_y"):
        # A field has 24 bits.
        np.testing.assert_allclose(changed.field(name), plain.field(name), rtol=0, atol=1e-6 * np.abs(plain.field("displacement_x")).max())


def test_a_column_that_a_leg_lacks_counts_nothing_there() -> None:
    simulation = sf.Simulation("cases/circle.toml", {"output.series": 0.1})
    simulation.step(200)
    simulation.change({"slider.viscosity_time_star": 0.1})
    simulation.step(100)
    lost = float(simulation.series["viscous_loss_j"].values[-1])
    assert lost > 0
    simulation.change({"slider.viscosity_time_star": 0.0})
    simulation.step(10)
    loss = simulation.series["viscous_loss_j"].values
    assert not loss[:201].any() and (np.diff(loss) >= 0).all() and loss[-1] == pytest.approx(lost, rel=0.02) and loss[-1] == loss[-10]


def test_changes_that_have_no_meaning_are_refused(small: sf.Case) -> None:
    simulation = sf.Simulation(small)
    simulation.step(5)
    with pytest.raises(sf.CaseError, match="cannot alter the blocks"):
        simulation.change({"slider.blocks": [5, 5]})
    with pytest.raises(sf.CaseError, match="v_star"):
        simulation.change({"drive.v_start": 1})
    remembering = sf.Simulation(sf.Case.load("cases/rate_and_state.toml"))
    with pytest.raises(sf.CaseError, match="have a state in addition to displacement and velocity"):
        remembering.change({"drive.v_star": 0.1})


def test_texture_may_change_on_the_way() -> None:
    case = sf.Case.load("cases/circle.toml", {"texture": []})
    simulation = sf.Simulation(case)
    simulation.run_until(time_star=80)
    loaded = simulation.mu_star
    mask = np.zeros(case.shape, dtype=bool)
    mask[20:30, 20:30] = True
    simulation.change({"time.duration_star": 100})
    simulation.textured = mask
    assert simulation.mu_star == pytest.approx(loaded, rel=0.02)
    assert simulation.textured.sum() == 100 and len(simulation.recipe()) == 3
    with pytest.raises(ValueError, match="shape of the lattice"):
        simulation.textured = mask[:10]
    simulation.run_until(lambda now: now.sliding_percent > 0, every=1)
    assert simulation.sliding_percent > 0
