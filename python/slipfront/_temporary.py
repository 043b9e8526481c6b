"""Folders of files that stand as long as something may read them."""

import os
import shutil
import tempfile
import weakref
from pathlib import Path


class TemporaryFolder:
    """A new folder that is removed when nothing refers to this object any more.

    Parameters
    ----------
    others
        Folders that stand at least as long.
    """

    def __init__(self, *others: "TemporaryFolder | None") -> None:
        self.path = Path(tempfile.mkdtemp(prefix="slipfront-"))
        self._others = others
        self.remove = weakref.finalize(self, _remove, self.path, os.getpid())


def _remove(path: Path, maker: int) -> None:
    # A process that was forked has a copy of this object, whose end is not that of the folder.
    if os.getpid() == maker:
        shutil.rmtree(path, ignore_errors=True)
