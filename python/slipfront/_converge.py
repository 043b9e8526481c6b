"""One slider on several meshes: the mesh error of its results."""

from __future__ import annotations

import dataclasses
import json
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import slipfront._slipfront as _slipfront
import slipfront._toml as _toml
from ._axes import Axis
from ._case import CaseLike, Overrides, as_case
from ._html import table, with_error
from ._pickle import sealed
from ._simulation import _threads
from ._slipfront import title
from ._study import Progress, StudyResults, executed, read_tables


@dataclasses.dataclass(frozen=True)
class QuantityOnMeshes:
    """A quantity on every mesh, the coarsest first, and its mesh error."""

    quantity: str
    """Name of the quantity, as in `summary.json`."""
    values: tuple[float, ...]
    """Mean over the surfaces of each mesh."""
    scatter: tuple[float | None, ...]
    """Half-width of the interval of each mean, due to the scatter over surfaces; None for one surface."""
    order: float | None
    """Order of convergence, 1/2 to 2; None unless differences decrease."""
    mesh_error: float | None
    """Mesh error of the finest mesh; None where no limit is claimed."""
    sentence: str
    """The value on the finest mesh with its errors, or why no limit is claimed."""

    def __repr__(self) -> str:
        return self.sentence


class Convergence(StudyResults):
    """Results of one slider on several meshes, and the tables of a study with the meshes as points.

    Attributes
    ----------
    folder
        Its path; None in memory.
    text
        The table and the sentences that the command prints.
    """

    def __init__(
        self,
        folder: Path | None,
        tables: dict[str, dict[str, list[Any]]],
        axes: list[Axis],
        failures: Sequence[tuple[str, str]],
        found: dict[str, Any],
        text: str,
    ) -> None:
        super().__init__(folder, tables, axes, failures)
        self._found, self.text = found, text

    @classmethod
    def read(cls, folder: Path, axes: list[Axis], failures: Sequence[tuple[str, str]] = ()) -> Convergence:
        """The results in a folder."""
        found = json.loads((folder / "convergence.json").read_bytes())
        text = (folder / "convergence.txt").read_text(encoding="utf-8")
        return cls(folder, read_tables(folder), axes, failures, found, text)

    @property
    def block_sizes(self) -> list[str]:
        """The edge of a block on every mesh, the coarsest first, as in a case file."""
        return [str(mesh["block_size"]) for mesh in self._found["meshes"]]

    @property
    def coverages(self) -> list[float]:
        """Textured area of every mesh, %."""
        return [float(mesh["coverage_percent"]) for mesh in self._found["meshes"]]

    @property
    def quantities(self) -> dict[str, QuantityOnMeshes]:
        """The quantities with a value on every mesh, by name."""
        # Each has a line that begins with its name.
        lines = (line.strip() for line in self.text.splitlines())
        sentences = {line.split(":")[0]: line for line in lines if ": " in line}
        return {found["quantity"]: self._quantity(found, sentences[found["quantity"]]) for found in self._found["quantities"]}

    @property
    def lengths_of_a_block(self) -> list[str]:
        """Material lengths that the block size replaces: with any, every mesh is another material, and no limit is claimed."""
        return list(self._found["lengths_of_a_block"])

    def to_dict(self) -> dict[str, Any]:
        """The content of `convergence.json`."""
        return dict(json.loads(json.dumps(self._found)))

    def to_list(self) -> list[dict[str, Any]]:
        """A dictionary for each quantity, with the entries of a `QuantityOnMeshes`."""
        return [dataclasses.asdict(quantity) for quantity in self.quantities.values()]

    def _quantity(self, found: dict[str, Any], sentence: str) -> QuantityOnMeshes:
        verdict = found["verdict"]
        converges = verdict["converges"] if "converges" in verdict else {}
        mesh_error = 0.0 if verdict == "equal" else converges.get("mesh_error")
        return QuantityOnMeshes(
            quantity=found["quantity"],
            values=tuple(found["means"]),
            scatter=tuple(found["half_widths"]),
            order=converges.get("order"),
            mesh_error=None if self.lengths_of_a_block else mesh_error,
            sentence=sentence,
        )

    def _repr_html_(self) -> str:
        def row(found: QuantityOnMeshes) -> list[str]:
            values = [with_error(*parts) for parts in zip(found.values, found.scatter, strict=True)]
            return [title(found.quantity), *values, "none claimed" if found.mesh_error is None else f"{found.mesh_error:.1g}"]

        rows = [row(found) for found in self.quantities.values()]
        return table(["blocks of", *self.block_sizes, "mesh error"], rows)

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(type(self), self.folder, self._tables, self._axes, self._failures, self._found, self.text)

    def __repr__(self) -> str:
        return self.text.rstrip()


def converge(
    case: CaseLike,
    overrides: Overrides | None = None,
    *,
    folder: str | os.PathLike[str] | None = None,
    force: bool = False,
    levels: int = 3,
    replicates: int | None = None,
    threads: int | None = None,
    max_memory: float | None = None,
    max_time: str | None = None,
    progress: Progress = None,
) -> Convergence:
    """Run a case on several meshes, for results with their mesh errors.

    The slider, its load, mount, damping, speed and duration stay the same in metres, seconds and pascals. Blocks have twice their
    size, their own, half of it, and so on. Ctrl-C ends the call with a `KeyboardInterrupt`, and an exception in `progress` ends it
    with that exception.

    Parameters
    ----------
    case
        A case, a dictionary of its tables, or the path of its file.
    overrides
        Keys of the case to change.
    folder
        A folder of results, byte for byte that of `slipfront converge`, in which a stopped call continues. By default results are in
        memory.
    force
        Replace files of the results that were edited since they were written.
    levels
        Number of meshes, 3 to 7. Each has half the block size of the one before; the second has that of the case.
    replicates
        Surfaces of each mesh, by default 5 if coefficients scatter, else 1.
    threads
        Runs in parallel, by default one per core. Results do not depend on it.
    max_memory
        Run nothing if all runs together need more memory, in GB.
    max_time
        Run nothing if the runs are estimated to take longer, such as ``"30min"`` or ``"2h"``.
    progress
        See `Study.run`.

    Raises
    ------
    CaseError
        When the case cannot have these meshes, or exceeds a limit.
    RunError
        When a run fails; the tables in the folder say why.

    Warns
    -----
    UserWarning
        When no quantity has a value on every mesh.

    Examples
    --------
    >>> coarse = {"slider.blocks": [20, 20], "slider.block_size": "50 um", "time.stop": "after_onset"}
    >>> found = converge("cases/sheet.toml", coarse, progress=False)
    >>> found.block_sizes
    ['100 um', '50 um', '25 um']
    >>> found.quantities["static_friction_star"]
    static_friction_star: 0.853 ± 0.021 (discretisation 0.021; order 2.0)
    """
    case = as_case(case, overrides)
    # A changed file would make another case.
    case._native.read_inputs()
    native, arrays = case._native, _toml.Arrays(case._native.arrays)
    # Its runs read arrays from files.
    text, array_files = arrays.on_disk(case._text())
    if array_files is not None:
        native = _slipfront.Case.parse(text, case.name, Path(), [], {})
    study = _slipfront.Study.on_meshes(native, levels, replicates)
    study.check_cost(_threads(threads), max_memory, max_time)
    found, _, _ = executed(study, Convergence, folder, force, progress, threads)
    if not found.quantities:
        warnings.warn("no quantity has a value on every mesh: `runs` contains the results of the runs", stacklevel=2)
    return found
