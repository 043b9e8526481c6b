"""Folders of files that exist as long as they may be read."""

import os
import shutil
import tempfile
import weakref
from pathlib import Path

import slipfront._slipfront as _slipfront


def _remove(path: Path, parent: _slipfront.TemporaryParent, process: int) -> None:
    """Remove a folder, unless this is a fork of the process that made it; the parent exists until then."""
    if os.getpid() == process:
        shutil.rmtree(path, ignore_errors=True)


class TemporaryFolder:
    """A new folder that is removed when nothing refers to this object any more.

    If the process is killed earlier, the next one that makes such a folder removes it.
    """

    def __init__(self) -> None:
        parent = _slipfront.TemporaryParent()
        self.path = Path(tempfile.mkdtemp(dir=parent.path))
        self.remove = weakref.finalize(self, _remove, self.path, parent, os.getpid())
