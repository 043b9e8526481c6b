"""Complete runs for a data repository, and their citations."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Literal, overload

import slipfront._slipfront as _slipfront
from ._run import Run

RunLike = Run | str | os.PathLike[str]


@overload
def export(
    runs: RunLike | Iterable[RunLike],
    form: Literal["ro-crate"],
    *,
    author: str | None = None,
    licence: str | None = None,
    folder: str | os.PathLike[str] | None = None,
    force: bool = False,
) -> Path: ...
@overload
def export(
    runs: RunLike | Iterable[RunLike],
    form: Literal["bibtex", "cff"],
    *,
    author: str | None = None,
    licence: str | None = None,
) -> str: ...
def export(
    runs: RunLike | Iterable[RunLike],
    form: Literal["ro-crate", "bibtex", "cff"],
    *,
    author: str | None = None,
    licence: str | None = None,
    folder: str | os.PathLike[str] | None = None,
    force: bool = False,
) -> Path | str:
    """Describe complete runs for a data repository, or cite them, as `slipfront export` does.

    Parameters
    ----------
    runs
        A run that has a folder, the path of a folder of results, such as that of a study, or several of these.
    form
        ``"ro-crate"``: write ``ro-crate-metadata.json``, with which a folder is a Process Run Crate; ``"bibtex"``: entries of each run, of
        slipfront and of the article of its model; ``"cff"``: a citation file, which needs an author.
    author
        Author of the runs: a name, or ``"NAME <https://orcid.org/0000-0000-0000-0000>"``.
    licence
        Licence of the results: an SPDX identifier such as ``"CC-BY-4.0"``, or an address.
    folder
        A new folder for the crate, to which the runs are copied; by default the folder of the run itself.
    force
        Replace an existing description in the folder of the run.

    Returns
    -------
    pathlib.Path or str
        The description, ``ro-crate-metadata.json``; or the text of the citations.

    Warns
    -----
    UserWarning
        When a crate has no author or no licence.

    Raises
    ------
    FolderError
        When a run has no folder or was changed, or when a file is in the place of the crate.
    ValueError
        When an argument is missing, or belongs to another form.

    Examples
    --------
    >>> import slipfront as sf
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     run = sf.run({"slider": {"blocks": [4, 4]}, "time": {"duration_star": 20}}, progress=False)
    ...     _ = run.save(folder + "/run")
    ...     sf.export(run, "bibtex").count("@")
    3
    """
    several: Iterable[RunLike] = [runs] if isinstance(runs, (Run, str, os.PathLike)) else runs
    folders = [_folder_of(run) for run in several]
    if form == "ro-crate":
        if folder is not None and force:
            raise ValueError("`force` replaces a description in the folder of a run, and `folder` names a new one: give one of them")
        path, notes = _slipfront.ro_crate(folders, author, licence, None if folder is None else Path(folder), force)
        for note in notes:
            warnings.warn(note, stacklevel=2)
        return path
    if form not in ("bibtex", "cff"):
        raise ValueError(f'form = {form!r}: it is "ro-crate", "bibtex" or "cff"')
    if folder is not None or force:
        raise ValueError(f'`folder` and `force` are for the form "ro-crate": the form {form!r} gives a text')
    return _slipfront.citation(folders, form == "cff", author, licence)


def _folder_of(run: RunLike) -> Path:
    """The folder of a run."""
    if not isinstance(run, Run):
        return Path(run)
    if run.folder is None:
        raise _slipfront.FolderError(f"the run of the case {run.case.name} has no folder: save it first")
    return run.folder
