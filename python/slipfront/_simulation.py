"""Simulations: a run taken step by step."""

from __future__ import annotations

import contextlib
import copy
import math
import operator
import os
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

import slipfront._dataset as _dataset
import slipfront._slipfront as _slipfront
from ._case import Case, CaseLike, Overrides, as_case
from ._finite import check_numbers
from ._legs import Past
from ._pickle import sealed
from ._progress import Bar, parted
from ._run import Run

if TYPE_CHECKING:
    import xarray as xr

Progress: TypeAlias = bool | Callable[["Simulation"], object] | None
"""``True`` for a bar, ``False`` for nothing, ``None`` for a bar in terminals and notebooks, or a function of the simulation."""

_ALL = 2**63


def run(
    case: CaseLike,
    overrides: Overrides | None = None,
    *,
    progress: Progress = None,
    threads: int | None = None,
    device: str = "cpu",
) -> Run:
    """Run a case to its end.

    Other Python threads continue meanwhile. Ctrl-C ends the run with a `KeyboardInterrupt`, and an exception in `progress` ends it with that
    exception.

    Parameters
    ----------
    case
        A case, a dictionary of its tables, or the path of its file.
    overrides
        Keys of the case to change.
    progress
        True for a bar, False for none, None (default) for a bar in terminals and notebooks; or a function that is called with
        the simulation every 50 ms.
    threads
        Largest number of threads, by default one per core. Results do not depend on it; a small slider uses one.
    device
        ``"cpu"``, or ``"gpu"`` for the first NVIDIA GPU. Results do not depend on it; a GPU is worth it for large sliders.

    Returns
    -------
    Run

    Raises
    ------
    RunError
        When the run diverges.
    RuntimeError
        When there is no GPU, or it does not cover the case.

    Examples
    --------
    >>> result = run("cases/circle.toml", {"drive.v_star": 0.05}, progress=False)
    >>> result.transition
    True
    >>> float(result.series["mu_star"].max()) == result.static_friction_star
    True
    """
    return Simulation(case, overrides, threads=threads, device=device).run(progress=progress)


class _Alone:
    """The native simulation; `with` gives it to one thread at a time.

    It is a class and not a generator, because a step of a small slider takes only a few times as long as entering it.

    Parameters
    ----------
    native
        None if it was unpickled in a process that cannot use it.
    """

    def __init__(self, native: _slipfront.Simulation | None) -> None:
        self._native = native
        self._lock = threading.Lock()

    def __enter__(self) -> _slipfront.Simulation:
        # The lock of a forked process may be locked although no thread there holds it.
        _slipfront.check_process()
        assert self._native is not None
        if not self._lock.acquire(blocking=False):
            raise RuntimeError(
                "another thread is using this simulation: wait for it, or give each thread a simulation of its own (copy.copy)"
            )
        return self._native

    def __exit__(self, *raised: object) -> None:
        self._lock.release()


class Simulation:
    """A run in progress, from rest.

    Lengths are in m, velocities in m/s, arrays over blocks have the shape (N_y, N_x) with the lowest row first. It can be copied and
    pickled; the copy continues bit-identically. It belongs to one thread at a time.

    Parameters
    ----------
    case
        A case, a dictionary of its tables, or the path of its file.
    overrides
        Keys of the case to change.
    threads
        Largest number of threads, by default one per core.
    device
        ``"cpu"``, or ``"gpu"`` for the first NVIDIA GPU. Copies, and the simulation after a `change`, run on the CPU.

    Examples
    --------
    >>> simulation = Simulation("cases/circle.toml")
    >>> simulation.step(100)
    100
    >>> simulation.displacement.shape
    (2, 50, 50)
    >>> twin = copy.copy(simulation)
    >>> _ = simulation.step(50), twin.step(50)
    >>> bool((simulation.displacement == twin.displacement).all())
    True
    """

    def __init__(
        self, case: CaseLike, overrides: Overrides | None = None, *, threads: int | None = None, device: str = "cpu"
    ) -> None:
        case, threads = as_case(case, overrides), _threads(threads)
        self._set(case, _slipfront.Simulation(case._native, threads, device), threads, Past())

    def _set(
        self, case: Case, native: _slipfront.Simulation | None, threads: int, past: Past, ended: str | None = None
    ) -> None:
        self._case, self._threads, self._past, self._ended = case, threads, past, ended
        self._alone = _Alone(native)

    @property
    def case(self) -> Case:
        """The case since the last change."""
        return self._case

    @property
    def ended(self) -> bool:
        """Whether the run ends here by its case; it continues after a change, for example of ``time.duration_star``."""
        return self._ended is not None

    @property
    def steps(self) -> int:
        """Steps since the start, including those before changes."""
        with self._alone as native:
            return self._past.steps + native.step

    @property
    def time_s(self) -> float:
        """Time since the start, s."""
        return self._past.counted("time_s") + self._point[0] * self._case.numbers["time_unit_s"]

    @property
    def time_star(self) -> float:
        """t* since the start, each leg in the unit of its own case."""
        return self._past.counted("time_star") + self._point[0]

    @property
    def mu_star(self) -> float:
        """mu* at this instant."""
        return self._point[1]

    @property
    def mu_lateral_star(self) -> float:
        """Friction across the drive at this instant, over the load and mu_s."""
        return self._point[2]

    @property
    def sliding_percent(self) -> float:
        """Share of sliding blocks N* at this instant, %."""
        return self._point[3]

    @property
    def _point(self) -> list[float]:
        with self._alone as native:
            return native.point

    @property
    def displacement(self) -> npt.NDArray[np.float64]:
        """Displacements of the blocks from rest along x and y, m, (2, N_y, N_x). The array is read-only."""
        with self._alone as native:
            moved, _ = native.motion()
        return _dataset.read_only(moved * self._case.numbers["displacement_unit_m"] + self._past.origin)

    @property
    def velocity(self) -> npt.NDArray[np.float64]:
        """Velocities of the blocks half a step later, m/s, (2, N_y, N_x). The array is read-only."""
        with self._alone as native:
            _, velocity = native.motion()
        return _dataset.read_only(velocity * self._case.numbers["speed_unit_m_s"])

    def field(self, name: str) -> npt.NDArray[np.float32]:
        """A field at this instant, (N_y, N_x), in the unit of `fields.nc`.

        Parameters
        ----------
        name
            ``contact_stress_star`` (over its largest value so far in this leg), ``traction`` (Pa), ``displacement_x``,
            ``displacement_y`` (m), ``velocity_x``, ``velocity_y`` (m/s) or ``sliding``.
        """
        with self._alone as native:
            field = native.field(name)
        axis = ("displacement_x", "displacement_y").index(name) if name.startswith("displacement") else None
        return field if axis is None else (field + self._past.origin[axis]).astype(np.float32)

    @property
    def series(self) -> xr.Dataset:
        """The curve since the start, as `Run.series`.

        After a `change` every column continues. Steps, times, the path of the drive, work and losses are summed over the legs. All
        other columns, stored energies included, are of their instant under the case of their leg. A column that a leg lacks is NaN
        there.
        """
        return _dataset.table(self._past.joined(self._columns()))

    def _columns(self) -> dict[str, Any]:
        with self._alone as native:
            return native.series()

    def step(self, n: int = 1) -> int:
        """Take n steps, or fewer if the run ends earlier.

        Returns
        -------
        int
            Steps taken.
        """
        n = operator.index(n)
        if n < 0:
            raise ValueError(f"steps are counted from 0, not {n}")
        taken = 0
        with self._alone as native:
            while True:
                steps, self._ended = native.advance(n - taken)
                taken += steps
                if self._ended is not None or taken == n:
                    return taken

    def run_until(
        self,
        condition: Callable[[Simulation], bool] | None = None,
        *,
        time_star: float = math.inf,
        every: int = 100,
        observer: Callable[[Simulation], object] | None = None,
    ) -> bool:
        """Step until a condition holds, a time is reached, or the run ends.

        Parameters
        ----------
        condition
            A function of this simulation, called every `every` steps.
        time_star
            t* since the start to stop at, rounded up to a step.
        every
            Steps between two calls of `condition` and `observer`.
        observer
            A function that is called with this simulation, at the start and every `every` steps.

        Returns
        -------
        bool
            Whether it stopped before the run ended.

        Examples
        --------
        >>> simulation = Simulation("cases/circle.toml")
        >>> simulation.run_until(lambda now: now.sliding_percent > 0, every=10)
        True
        """
        if every < 1:
            raise ValueError(f"every is a number of steps from 1 on, not {every}")
        if math.isnan(time_star):
            raise ValueError("t* is a number, not NaN")
        if time_star < (now := self.time_star):
            raise ValueError(f"t* = {time_star:g} has passed: it is {now:g} now")
        in_leg = (time_star - self._past.counted("time_star")) / self._case.numbers["dt_star"]
        last = math.ceil(in_leg - 1e-9) if in_leg < math.inf else _ALL
        while True:
            if observer is not None:
                observer(self)
            if condition is not None and condition(self):
                return True
            with self._alone as native:
                left = last - native.step
            if left <= 0:
                return True
            if self._ended is not None:
                return False
            self.step(min(every, left))

    def run(self, progress: Progress = None) -> Run:
        """Run to the end and return the results; the simulation cannot be used afterwards.

        Parameters
        ----------
        progress
            See `slipfront.run`.
        """
        if self._past.legs:
            raise RuntimeError(
                "a run with changes has no results of one case: read `series` and the fields, and keep `recipe()`"
            )
        shown, watch = parted(progress)
        last = self._case.last_step
        # A short run ends before a bar would be useful.
        with self._alone as native:
            if self._ended is None:
                _, self._ended = native.advance(_ALL)
        if self._ended is None:
            with Bar(shown, last, "step", self._case.name) as bar:
                while self._ended is None:
                    if watch is not None:
                        watch(self)
                    with self._alone as native:
                        bar.show(native.step, said=f"mu* = {native.point[1]:.3f}")
                        _, self._ended = native.advance(_ALL)
        with self._alone as native:
            return Run(self._case, native.record(self._ended))

    def change(self, overrides: Overrides) -> None:
        """Continue under another case from here: a new leg of the same slider.

        Displacements in m, velocities in m/s and the position of the drive are kept. Scales, load and state (stuck or not) of each
        block are of the new case; its durations and programs count from here. `steps`, `time_s`, `time_star` and `series` continue.

        Parameters
        ----------
        overrides
            Keys of the case to change: speed, direction, load, texture, coefficients, duration.

        Raises
        ------
        CaseError
            When the new case is invalid, has other blocks, or has contacts with a further memory, such as an age.

        Examples
        --------
        >>> simulation = Simulation("cases/circle.toml")
        >>> _ = simulation.run_until(time_star=80)
        >>> simulation.change({"drive.v_star": 0.1, "time.duration_star": 50})
        >>> simulation.case.numbers["v_star"], round(simulation.time_star)
        (0.1, 80)
        """
        case, curve = self._case.replace(overrides), self._columns()
        with self._alone as native:
            begun, drive, steps, counts = native.change(case._native, self._threads)
        self._set(case, begun, self._threads, self._past.after(self._case, steps, curve, dict(counts), drive))

    @property
    def textured(self) -> npt.NDArray[np.bool_]:
        """Whether each block is textured, (N_y, N_x). Setting the property is a `change`: a new leg with this texture."""
        return self._case.textured

    @textured.setter
    def textured(self, mask: npt.ArrayLike) -> None:
        check_numbers("mask", mask)
        wanted = np.asarray(mask, dtype=bool)
        if wanted.shape != self._case.shape:
            raise ValueError(f"a texture has the shape of the lattice, {self._case.shape}, not {wanted.shape}")
        self.change({"texture": [{"shape": "mask", "file": wanted}] if wanted.any() else []})

    def recipe(self) -> list[tuple[str, int]]:
        """Recipe of this state: the resolved case of every leg, and the number of its steps.

        The last leg is the current one. Every change completes the current step.
        """
        with self._alone as native:
            now = native.step
        return [*((case.to_toml(), steps) for case, steps in self._past.legs), (self._case.to_toml(), now)]

    def checkpoint(self) -> bytes:
        """State from which `resume` continues bit-identically."""
        with self._alone as native:
            return native.checkpoint()

    @classmethod
    def resume(cls, case: CaseLike, checkpoint: bytes, *, threads: int | None = None) -> Simulation:
        """The simulation of a case, continued from a checkpoint.

        Raises
        ------
        ValueError
            When it is not a checkpoint of this case by this build of slipfront, or is damaged.
        """
        case = as_case(case)
        return cls._of(case, _slipfront.Simulation.resume(case._native, checkpoint, _threads(threads)), threads)

    @classmethod
    def _of(cls, case: Case, native: _slipfront.Simulation | None, threads: int | None) -> Simulation:
        simulation = cls.__new__(cls)
        simulation._set(case, native, _threads(threads), Past())
        return simulation

    def __copy__(self) -> Simulation:
        other = self.resume(self._case, self.checkpoint(), threads=self._threads)
        other._ended, other._past = self._ended, self._past
        return other

    def __deepcopy__(self, memo: dict[int, Any]) -> Simulation:
        return copy.copy(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return sealed(_unpickled, self._case, self.checkpoint(), self._threads, self._ended, self._past)

    def __repr__(self) -> str:
        return f"Simulation({self._case.name}: step {self.steps}, t* = {self.time_star:.4g}, mu* = {self.mu_star:.4g})"


def _unpickled(case: Case, checkpoint: bytes, threads: int, ended: str | None, past: Past) -> Simulation:
    native = None
    # A process that was forked too late gets the error when it uses the simulation, as with a case.
    with contextlib.suppress(_slipfront.ForkError):
        native = _slipfront.Simulation.resume(case._native, checkpoint, _threads(threads))
    simulation = Simulation._of(case, native, threads)
    simulation._ended, simulation._past = ended, past
    return simulation


def _threads(asked: int | None) -> int:
    cores = os.cpu_count() or 1
    if asked is None:
        return cores
    if asked < 1:
        raise ValueError(f"threads are counted from 1, not {asked}")
    return min(asked, cores)
