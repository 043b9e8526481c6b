#!/usr/bin/env python3
"""Packs a folder such that the archive depends on names, contents and the right to execute alone:

    release/pack.py FOLDER ARCHIVE.tar.gz
    release/pack.py FOLDER ARCHIVE.zip

Times are that of SOURCE_DATE_EPOCH. Needs Python 3.9 or later.
"""

import gzip
import io
import os
import sys
import tarfile
import time
import zipfile
from pathlib import Path


def pack_tar(files, archive, seconds):
    """Writes names, contents and modes as a compressed tar archive."""
    with archive.open("wb") as raw, gzip.GzipFile("", "wb", fileobj=raw, mtime=0) as packed:
        with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as tar:
            for name, contents, mode in files:
                entry = tarfile.TarInfo(name)
                entry.size, entry.mode, entry.mtime = len(contents), mode, seconds
                tar.addfile(entry, io.BytesIO(contents))


def pack_zip(files, archive, seconds):
    """Writes names, contents and modes as a zip archive."""
    with zipfile.ZipFile(archive, "w") as packed:
        for name, contents, mode in files:
            entry = zipfile.ZipInfo(name, time.gmtime(seconds)[:6])
            entry.external_attr, entry.compress_type, entry.create_system = (0o100000 | mode) << 16, zipfile.ZIP_DEFLATED, 3
            packed.writestr(entry, contents)


def main():
    folder, archive = map(Path, sys.argv[1:])
    seconds = int(os.environ["SOURCE_DATE_EPOCH"])
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    files = [
        (path.relative_to(folder.parent).as_posix(), path.read_bytes(), 0o755 if os.access(path, os.X_OK) else 0o644) for path in paths
    ]
    (pack_zip if archive.suffix == ".zip" else pack_tar)(files, archive, seconds)


if __name__ == "__main__":
    main()
