"""Folders of files that stand as long as something may read them."""

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
        self.remove = weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)
