"""Many runs in one call: the numbers of `run`, errors with the place of the case, interrupts."""

import os
import signal
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

import slipfront as sf


def test_map_gives_the_summaries_of_run_in_order(small: sf.Case) -> None:
    """Cases of any kind, with runs of unequal lengths, on any number of threads."""
    tables = {"slider": {"blocks": [9, 7]}, "drive": {"loading": "held"}, "time": {"stop": "after_onset", "kinetic_from_star": 200}}
    path = Path("cases/circle.toml")
    cases: list[sf.Case | Mapping[str, Any] | Path | str] = [small, tables, path, str(path)]
    cases += [small.replace({"friction.seed": seed, "time.duration_star": 20 + 7 * seed % 90}) for seed in range(20)]
    made = [small, sf.Case(tables), sf.Case.load(path), sf.Case.load(path)]
    made += [case for case in cases[4:] if isinstance(case, sf.Case)]
    expected = [sf.run(case, progress=False).summary for case in made]
    for threads in (1, 2, 5, None):
        assert sf.map(cases, threads=threads) == expected, threads
    assert sf.map(iter(cases)) == expected
    assert sf.map([]) == []


def test_map_has_the_numbers_of_every_case() -> None:
    cases = [sf.Case.load(path, {"slider.blocks": [12, 12]}) for path in ("cases/circle.toml", "cases/rate_and_state.toml")]
    edge = {"slider": {"blocks": [20, 6]}, "drive": {"attach": "left", "v_star": 0.05}, "time": {"duration_star": 200}}
    program = {"slider": {"blocks": [8, 8]}, "drive": {"program": [{"until_star": 40, "v_star": 0.1}, {"v_star": 0.2}]}}
    cases += [sf.Case(tables) for tables in (edge, program)]
    cases += [cases[0].replace({"output.snapshots": snapshots}) for snapshots in ([], [10, 20], {"every": 30})]
    summaries = [sf.run(case, progress=False).summary for case in cases]
    assert summaries[2]["precursors"]["events"] > 0 and len(summaries[3]["cycles"]) > 0
    assert sf.map(cases) == summaries


def test_errors_name_the_case(small: sf.Case, diverging: sf.Case) -> None:
    with pytest.raises(sf.CaseError, match=r"^case 1: .*did you mean `v_star`") as raised:
        sf.map([small, {"drive": {"v_start": 1}}])
    assert (raised.value.line, raised.value.column) == (2, 1)
    with pytest.raises(sf.CaseError, match=r"^case 0: .*nowhere.toml"):
        sf.map(["nowhere.toml"])
    for threads in (1, 3):
        # The second one that diverges ends no earlier than the first, whichever is seen first.
        with pytest.raises(sf.RunError, match=r"^case 2 \(case\): .*at step .* diverged"):
            sf.map([small, small, diverging, small, diverging], threads=threads)
    with pytest.raises(ValueError, match="threads are counted from 1, not 0"):
        sf.map([small], threads=0)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_ends_all_runs(long: sf.Case) -> None:
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        sf.map([long] * 20, threads=2)
    timer.join()


def test_other_threads_go_on(long: sf.Case) -> None:
    case = long.replace({"time.duration_star": 1000})
    worker = threading.Thread(target=lambda: sf.map([case, case]))
    worker.start()
    counted = 0
    while worker.is_alive():
        counted += 1
        time.sleep(0.001)
    assert counted > 3


@pytest.mark.parametrize("many", [False, True])
def test_a_device_that_is_missing_is_refused(small: sf.Case, many: bool) -> None:
    """The module that tests build lacks the feature `gpu`; one with that feature finds no GPU on a machine without."""

    def run(device: str) -> dict[str, Any]:
        return sf.map([small], device=device)[0] if many else sf.run(small, device=device, progress=False).summary

    assert run("cpu") == sf.run(small, progress=False).summary
    with pytest.raises(ValueError, match="the device is `cpu` or `gpu`, not `tpu`"):
        run("tpu")
    with pytest.raises(RuntimeError, match='; `device="cpu"` gives the same results'):
        run("gpu")
