"""Pickles with a checksum: damaged ones are refused.

A checksum finds damage, not malice. Loading a pickle can run any program in it, so never load pickles from strangers.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any

import slipfront._slipfront as _slipfront


def sealed(make: Callable[..., object], *state: Any) -> tuple[Callable[[bytes], object], tuple[bytes]]:
    """The result of `__reduce__` for an object that `make` makes from its state: one function, and the rest as bytes with their checksum."""
    contents = pickle.dumps((make, state), pickle.HIGHEST_PROTOCOL)
    return _unsealed, (_slipfront.with_checksum(contents),)


def _unsealed(sealed: bytes) -> object:
    contents = _slipfront.verified(sealed)
    if contents is None:
        raise pickle.UnpicklingError("this pickle of slipfront is damaged, its checksum is wrong: create it again")
    make, state = pickle.loads(contents)
    return make(*state)
