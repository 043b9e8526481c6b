"""Display of the progress of a run or a study."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from types import TracebackType
from typing import Any, TypeVar


Watch = TypeVar("Watch", bound=Callable[..., object])


def parted(progress: bool | Watch | None) -> tuple[bool | None, Watch | None]:
    """Whether a bar is shown, None where the terminal decides, and the user's progress function, if any."""
    return (False, progress) if callable(progress) else (progress, None)


class Bar:
    """A bar of tqdm, or if that is not installed, a line of text.

    Parameters
    ----------
    shown
        Whether it is shown; None: in a terminal or notebook.
    total
        Total amount, None if it is not known yet.
    unit
        Unit of the amount.
    title
        Title of the bar.
    """

    def __init__(self, shown: bool | None, total: int | None, unit: str, title: str) -> None:
        self._bar: Any = None
        self._last = -1
        self._total = total
        self._title = title
        self._text = False
        if shown is None:
            shown = sys.stderr.isatty() or "ipykernel" in sys.modules
        if not shown:
            return
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._text = True
        else:
            # A bar of less than a second leaves no trace, for example in a stored notebook.
            self._bar = tqdm(total=total, unit=unit, desc=title, unit_scale=unit == "step", leave=False, delay=1)

    def show(self, done: int, total: int | None = None, said: str = "") -> None:
        """Show the amount done, the total if it has changed, and a few words."""
        self._total = self._total if total is None else total
        if self._bar is not None:
            self._bar.total = self._total
            self._bar.set_postfix_str(said, refresh=False)
            self._bar.update(done - self._bar.n)
        elif self._text and self._total:
            percent = 100 * done // self._total
            if percent != self._last:
                self._last = percent
                print(f"\r{self._title} {percent} % {said}", end="", file=sys.stderr, flush=True)

    def __enter__(self) -> Bar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._text and self._last >= 0:
            print(file=sys.stderr)


@contextlib.contextmanager
def shown_runs(
    progress: bool | Callable[..., object] | None, title: str, words: Callable[..., str] = lambda: ""
) -> Iterator[Callable[..., None]]:
    """A function that shows the numbers of finished runs and of all, and the words for further numbers."""
    shown, watch = parted(progress)
    with Bar(shown, None, "run", title) as bar:

        def show(done: int, total: int, *further: Any) -> None:
            if watch is not None:
                watch(done, total, *further)
            bar.show(done, total, words(*further))

        yield show
