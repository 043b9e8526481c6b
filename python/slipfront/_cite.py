"""How to cite."""

from __future__ import annotations

from ._slipfront import __version__


def cite() -> str:
    """Return the text to cite: the program, and the paper with its model.

    Examples
    --------
    >>> "10.1016/j.triboint.2023.108866" in cite()
    True
    """
    return (
        f"The slipfront developers: slipfront, version {__version__}. A two-dimensional lattice spring-block model of the "
        "transition from static to kinetic friction of micro-textured surfaces.\n"
        "The model: S. K. Jalali and N. M. Pugno. 2D Spring-block model to study the transition from static to kinetic friction of "
        "complex-micro-textured contact surfaces. Tribology International 188 (2023). doi:10.1016/j.triboint.2023.108866"
    )
