"""Shared parts of the tests: the repository, from whose root they are run, and small cases."""

import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

import slipfront as sf

ROOT = Path(__file__).parents[2]
CASES = sorted((ROOT / "cases").glob("*.toml"))


@pytest.fixture
def small() -> sf.Case:
    """A case that takes some milliseconds."""
    return sf.Case({"slider": {"blocks": [12, 10]}, "time": {"duration_star": 150}}, name="small")


@pytest.fixture
def long() -> sf.Case:
    """A case that takes minutes."""
    return sf.Case({"slider": {"blocks": [40, 40]}, "time": {"duration_star": 1e6}}, name="long")


@pytest.fixture
def diverging() -> sf.Case:
    """A case with steps just below the limit of the linear lattice, and strains that stiffen its springs beyond it."""
    tables = {
        "slider": {"blocks": [8, 8], "omega_star": 0},
        "load": {"pressure": "50 GPa"},
        "drive": {"v_star": 10},
        "friction": {"r_star": 0, "sigma_static_star": 1},
        "time": {"step": 0.9, "duration_star": 2000},
    }
    return sf.Case(tables)


@pytest.fixture
def interruptible() -> Iterator[None]:
    """An interrupt raises KeyboardInterrupt also where it is ignored, as in a script that was started in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
