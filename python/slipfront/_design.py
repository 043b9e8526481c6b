"""Designs: the search for a texture with the desired friction."""

from __future__ import annotations

import dataclasses
import json
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

import slipfront._slipfront as _slipfront
from ._case import Case, CaseLike, Overrides
from ._finite import check_numbers
from ._html import numbers, picture, with_error
from ._keys import DesignKeys
from ._pickle import sealed
from ._progress import shown_runs
from ._project import of_case, of_file
from ._simulation import _threads
from ._temporary import TemporaryFolder

if TYPE_CHECKING:
    from typing_extensions import Unpack

Mask: TypeAlias = npt.NDArray[np.bool_]
"""A texture of shape (ny, nx), the smallest y first: True where a block is textured."""


@dataclasses.dataclass(frozen=True)
class Least:
    """Target: the least value of a quantity, `static_friction`, `kinetic_friction` or `friction_drop`."""

    quantity: str

    def _table(self) -> dict[str, Any]:
        return {"least": self.quantity}


@dataclasses.dataclass(frozen=True)
class Largest:
    """Target: the largest value of a quantity, `static_friction`, `kinetic_friction` or `friction_drop`."""

    quantity: str

    def _table(self) -> dict[str, Any]:
        return {"largest": self.quantity}


@dataclasses.dataclass(frozen=True)
class Value:
    """Target: a value of a quantity, or with ``_star`` after its name, a share of mu_s; a force is a text such as ``"12 mN"``."""

    value: float | str
    of: str = "static_friction"

    def _table(self) -> dict[str, Any]:
        return {"value": self.value, "of": self.of}


Wish: TypeAlias = Least | Largest | Value | Mapping[str, Any]
"""A target, or the table `wish` of a design file."""

DesignProgress: TypeAlias = bool | Callable[[int, int, float], object] | None
"""True for a bar, False for none, None for one in terminals and notebooks, or a function of the numbers of finished runs and of all, and of
the value of the best draft."""


class Design:
    """A design: a target, limits, and the case in which textures are tried.

    Parameters
    ----------
    case
        The case, a dictionary of its tables or the path of its file; or the path of a design file, with `overrides` alone.
    overrides
        Keys of the case to change.
    wish
        The target of the texture.
    coverage
        Least and largest textured share of the slider, %.
    keys
        Other keys of the table ``[design]``, such as ``feature``, ``gap``, ``runs``, ``tolerance`` or ``forbidden``. Masks in textures
        may be arrays. With ``unknowns``, such as ``{"texture.0.lambda": ("2 um", "6 um")}``, the search is for numbers of the textures
        of the case.

    Examples
    --------
    >>> slider = {"slider": {"blocks": [16, 16]}, "drive": {"v_star": 0.1}}
    >>> design = Design(slider, wish=Least("static_friction"), coverage=(0, 15), feature_blocks=2, gap_blocks=2, runs=150)
    >>> found = design.run(progress=False)
    >>> found.mask.shape, bool(found.coverage <= 15)
    ((16, 16), True)

    Numbers of a shape instead of a mask:

    >>> disc = slider | {"texture": [{"shape": "cavity", "lambda": "2 um"}]}
    >>> wish = Value(0.7, "static_friction_star")
    >>> unknowns = {"texture.0.lambda": ("1 um", "6 um")}
    >>> shapes = Design(disc, wish=wish, coverage=(0, 40), unknowns=unknowns, tolerance=0.02, runs=60)
    >>> found = shapes.run(progress=False)
    >>> list(found.unknowns), found.within_tolerance[1]
    (['texture.0.lambda'], 64)

    Another search algorithm: ask for legal textures, or draw some, and report their losses.

    >>> masks = design.ask(4)
    >>> losses = design.evaluate(masks)
    >>> design.tell(masks, losses)
    >>> bool(design.best[1] == min(losses))
    True
    """

    def __init__(
        self,
        case: CaseLike,
        overrides: Overrides | None = None,
        *,
        wish: Wish | None = None,
        coverage: tuple[float, float] | None = None,
        name: str | None = None,
        **keys: Unpack[DesignKeys],
    ) -> None:
        if isinstance(case, (str, os.PathLike)) and wish is None and coverage is None and name is None and not keys:
            self._native, self._arrays = of_file(_slipfront.Design, case, overrides)
            return
        if wish is None or coverage is None:
            raise ValueError("give a case with `wish` and `coverage`, or the path of a design file alone")
        target = wish if isinstance(wish, Mapping) else wish._table()
        tables = {"design": {"wish": target, "coverage": coverage, **keys}}
        self._native, self._arrays = of_case(_slipfront.Design, case, overrides, tables, name, "design")

    @property
    def name(self) -> str:
        """Name of the design."""
        return self._native.name

    def illegal(self, mask: npt.ArrayLike) -> str | None:
        """Reason why a texture breaks a limit; None if it breaks none."""
        return self._native.illegal(self._bytes(mask))

    def ask(self, n: int) -> list[Mask]:
        """Up to `n` legal textures that were not returned before; fewer if the limits leave few.

        The search learns from the losses of every eight. More at once come from several parallel starts, which suits many runs.
        """
        return [self._mask(texture) for texture in self._native.ask(n)]

    def tell(self, masks: Iterable[npt.ArrayLike], losses: Sequence[float]) -> None:
        """Report the losses of textures, from `ask` or from any other source; smaller is better."""
        texts = [self._bytes(mask) for mask in masks]
        if len(texts) != len(losses):
            raise ValueError(f"there are {len(texts)} masks and {len(losses)} losses: give one for each")
        # The loss of a texture that breaks a limit is infinite.
        check_numbers("losses", losses, may_be_infinite=True)
        self._native.tell(texts, [float(loss) for loss in losses])

    @property
    def best(self) -> tuple[Mask, float]:
        """The best texture with a known loss, and its loss."""
        found = self._native.best()
        if found is None:
            raise LookupError("no loss was reported yet")
        return self._mask(found[0]), found[1]

    def evaluate(
        self, masks: Iterable[npt.ArrayLike], *, surfaces: int = 1, coarse: bool = True, threads: int | None = None
    ) -> list[float]:
        """Losses of textures, distances from the target. A texture that breaks a limit has an infinite loss. So has one with a run that
        diverges or never comes to rest, with a warning that gives the reason.

        For the least value the loss is the ratio to the slider without texture, and for the largest minus that ratio. For a value it
        is the relative distance from it, and for a curve the root mean square of the differences of mu*.

        Parameters
        ----------
        masks
            Textures.
        surfaces
            Random surfaces of the search over which the mean is taken. The verdict of `run` uses others.
        coarse
            Whether the time step is coarse, as in the first stage of the search, or that of the case.
        threads
            Runs in parallel, by default one per core. Results do not depend on it.
        """
        texts = [self._bytes(mask) for mask in masks]
        legal = [text for text in texts if self._native.illegal(text) is None]
        losses = dict(zip(legal, self._native.losses(legal, surfaces, coarse, _threads(threads)), strict=True))
        for number, text in enumerate(texts):
            _, why = losses.get(text, (None, None))
            if why is not None:
                warnings.warn(f"mask {number} is lost: {why}", RuntimeWarning, stacklevel=2)
        return [losses[text][0] if text in losses else float("inf") for text in texts]

    def run(
        self,
        folder: str | os.PathLike[str] | None = None,
        *,
        runs: int | None = None,
        time: float | None = None,
        force: bool = False,
        progress: DesignProgress = None,
        threads: int | None = None,
    ) -> DesignResults:
        """Search for the texture, and test it on surfaces that the search did not use.

        Parameters
        ----------
        folder
            A folder of results, byte for byte that of `slipfront design`, in which a stopped call continues. By default results are in
            memory.
        runs
            Runs of the search, instead of those of the design.
        time
            Seconds after which the search stops; results then depend on the speed of the machine.
        force
            Replace files of the results that were edited since they were written.
        progress
            See `DesignProgress`.
        threads
            Runs in parallel, by default one per core. Results do not depend on it.

        Raises
        ------
        CaseError
            When no texture satisfies the limits.

        Warns
        -----
        UserWarning
            When there is no verdict, because every tested texture failed.
        """
        temporary = TemporaryFolder()
        with shown_runs(progress, self.name, lambda best: f"best {best:.4g}" if best == best else "verdict") as show:
            path = temporary.path / self.name if folder is None else Path(folder)
            self._native.execute((path, force), runs, time, _threads(threads), show)
            results = DesignResults.read(path, None if folder is None else path)
        if results.to_dict()["design"]["lost"] is not None:
            warnings.warn("every tested texture failed on new surfaces: `text` gives the reasons", stacklevel=2)
        return results

    def _bytes(self, mask: npt.ArrayLike) -> bytes:
        array = np.asarray(mask)
        check_numbers("mask", array)
        columns, rows = self._native.size
        if array.shape != (rows, columns):
            raise ValueError(f"a mask of this slider has the shape ({rows}, {columns}), that is (ny, nx), not {array.shape}")
        return np.ascontiguousarray(array.astype(np.bool_)).tobytes()

    def _mask(self, texture: bytes) -> Mask:
        columns, rows = self._native.size
        return np.frombuffer(texture, dtype=np.bool_).reshape(rows, columns)

    def __repr__(self) -> str:
        columns, rows = self._native.size
        return f"Design({self.name}: {columns} x {rows} blocks)"


class DesignResults:
    """Results of a design.

    Attributes
    ----------
    folder
        Its path; None in memory.
    mask
        The texture, of shape (ny, nx), the smallest y first.
    text
        The verdict as the command prints it.
    """

    def __init__(self, folder: Path | None, mask: Mask, case_text: str, found: dict[str, Any], text: str) -> None:
        self.folder, self.mask, self.text = folder, mask, text
        self._case_text, self._found = case_text, found

    @classmethod
    def read(cls, folder: Path, kept: Path | None) -> DesignResults:
        """Results in a folder, which is kept as `kept` or removed afterwards."""
        mask = np.load(folder / "mask.npy")
        found = json.loads((folder / "design.json").read_bytes())
        text = (folder / "design.txt").read_text(encoding="utf-8")
        return cls(kept, mask, (folder / "case.toml").read_text(encoding="utf-8"), found, text)

    @property
    def case(self) -> Case:
        """The case with this texture, in its folder; in memory, `Case.replace` gives a case the mask: ``{"texture": [...]}``."""
        if self.folder is None:
            raise LookupError("a design in memory has no case file: give the case the texture [{'shape': 'mask', 'file': results.mask}]")
        return Case.load(self.folder / "case.toml")

    @property
    def coverage(self) -> float:
        """Textured share of the slider, %."""
        return float(self._found["as_meshed"]["coverage_percent"])

    @property
    def unknowns(self) -> dict[str, float]:
        """Numbers that were found, by key and in the units of their ranges; empty for a mask."""
        return {found["key"]: float(found["value"]) for found in self._found.get("unknowns", [])}

    @property
    def within_tolerance(self) -> tuple[int, int] | None:
        """Parts within the tolerance of the target, and all tested parts; None without a tolerance."""
        found = self._found["design"].get("within_tolerance")
        return None if found is None else (int(found["within"]), int(found["parts"]))

    @property
    def loss(self) -> float:
        """Loss of the design on fresh surfaces, as `Design.evaluate` returns it; infinite if a run of it diverged or never came to rest."""
        loss = self._found["design"]["loss"]
        return float("inf") if loss is None else float(loss)

    @property
    def static_friction_star(self) -> tuple[float, float | None]:
        """The largest mu* on fresh surfaces in the first case, and half of the width of its 95 % interval."""
        mean = self._found["design"]["cases"][0]["static_friction_star"]
        return mean["mean"], mean["half_width"]

    @property
    def is_named(self) -> bool:
        """Whether the design is a named pattern, because no searched texture is better."""
        return bool(self._found["is_named"])

    def to_dict(self) -> dict[str, Any]:
        """The content of `design.json`."""
        return dict(json.loads(json.dumps(self._found)))

    def _repr_html_(self) -> str:
        within, (mean, error) = self.within_tolerance, self.static_friction_star
        rows = [("mu_s*", with_error(mean, error)), ("A*", f"{self.coverage:.4g} %"), ("loss", f"{self.loss:.4g}")]
        rows += [(key, f"{value:.4g}") for key, value in self.unknowns.items()]
        rows += [] if within is None else [("within the tolerance", f"{within[0]} of {within[1]}")]
        return picture(self.mask) + numbers(rows)

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(type(self), self.folder, self.mask, self._case_text, self._found, self.text)

    def __repr__(self) -> str:
        return self.text.rstrip()
