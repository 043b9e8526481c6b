"""Many small runs in one call."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

import slipfront._slipfront as _slipfront
from ._case import Case, CaseError, CaseLike, Overrides, as_case
from ._simulation import _threads


def map(
    cases: Iterable[CaseLike], overrides: Overrides | None = None, *, threads: int | None = None, device: str = "cpu"
) -> list[dict[str, Any]]:
    """Run cases, and return the numbers of each.

    Every run has one thread, and ends according to its `time.stop`. No file is written. All cases are in memory until the last run ends,
    but only the numbers of each run: `run` gives the curve and the fields of a case. Other Python threads continue meanwhile. Ctrl-C ends
    the call with a `KeyboardInterrupt`.

    Parameters
    ----------
    cases
        Cases, dictionaries, or paths of case files.
    overrides
        Keys to change in every case.
    threads
        Runs in parallel, by default one per core. Results do not depend on it.
    device
        ``"cpu"``, or ``"gpu"`` for the first NVIDIA GPU; cases that it does not cover run on the CPU meanwhile. Results do not depend on it.

    Returns
    -------
    list of dict
        `Run.summary` of every case, in their order and bit-identical.

    Raises
    ------
    CaseError
        When one of them is invalid, before any is run; the message begins with its index in the list, from 0.
    RunError
        When a run diverges; the message begins with the index of the first one that does.
    RuntimeError
        When there is no GPU, or it fails.

    Examples
    --------
    >>> base = Case({"slider": {"blocks": [10, 10]}})
    >>> found = map((base.replace({"friction.seed": seed}) for seed in (1, 2)), {"time.stop": "after_onset"})
    >>> [round(numbers["static_friction_star"], 3) for numbers in found]
    [0.912, 0.878]
    """
    made = [_made(index, given, overrides) for index, given in enumerate(cases)]
    summaries = _slipfront.run_summaries([case._native for case in made], _threads(threads), device)
    return [json.loads(summary) for summary in summaries]


def _made(index: int, given: CaseLike, overrides: Overrides | None) -> Case:
    try:
        return as_case(given, overrides)
    except CaseError as error:
        located = CaseError(f"case {index}: {error}")
        located.line, located.column = error.line, error.column
        raise located from error
