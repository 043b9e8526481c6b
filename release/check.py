#!/usr/bin/env python3
"""Looks into the files of a release: what each must contain, and which libraries of the system its programs ask for:

    release/check.py FOLDER

FOLDER is that of release/build.sh, target/dist. Needs readelf and objdump of binutils. Exit status: 1 if something is missing, or if a program
asks for what its platform does not promise.
"""

import re
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

NOTICES = "THIRD-PARTY-NOTICES.txt"
MODULES = ["slipfront.wasm", "slipfront-work.wasm"]
# What an archive contains, by the end of its name, as ends of the paths in it.
CONTENTS = {
    "-linux-x86_64.tar.gz": ["/slipfront"],
    "-linux-aarch64.tar.gz": ["/slipfront"],
    "-windows-x86_64.zip": ["/slipfront.exe"],
    "-lab.zip": ["/index.html", *(f"/{module}" for module in MODULES), f"/{NOTICES}"],
    "-source.tar.gz": ["/Cargo.lock", "/release/build.sh", "/LICENSE-MIT", "/LICENSE-APACHE", f"/{NOTICES}"],
    ".whl": [
        *(f"slipfront/{file}" for file in ["__init__.py", "_slipfront.pyi", *MODULES]),
        f"/licenses/{NOTICES}",
        ".cyclonedx.json",
    ],
    ".tar.gz": ["/PKG-INFO", "/Cargo.lock", f"/{NOTICES}"],
}
COMMAND = [f"/{file}" for file in [*MODULES, "cases/baseline.toml", "LICENSE-MIT", "LICENSE-APACHE", NOTICES, "slipfront.cdx.json"]]
# Libraries that are parts of Windows since Windows 10.
WINDOWS = (
    r"kernel32|ntdll|msvcrt|ws2_32|advapi32|userenv|bcrypt|bcryptprimitives|api-ms-win-[\w-]+|"
    r"combase|oleaut32|pdh|powrprof|psapi|rpcrt4|shell32"
)
# Libraries that a program may ask for: of Linux those of PEP 600 and PEP 656.
LIBRARIES = {
    "linux": r"",
    "manylinux": r"ld-linux-(x86-64|aarch64)\.so\.[12]|lib(c|m|dl|rt|util|pthread|gcc_s)\.so\.\d",
    "musllinux": r"libc\.(so|musl-\w+\.so\.1)",
    "windows": rf"({WINDOWS})\.dll",
    "win_amd64": rf"({WINDOWS}|python3)\.dll",
}
# The newest symbols of glibc that manylinux2014 has.
GLIBC = (2, 17)


def members(path):
    """Names and contents of the files in an archive."""
    if path.suffix == ".gz":
        with tarfile.open(path) as archive:
            return {entry.name: archive.extractfile(entry).read() for entry in archive if entry.isfile()}
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}


def said(*line):
    """Standard output of a program."""
    return subprocess.run(line, capture_output=True, text=True, check=True).stdout


def imports(program):
    """Libraries that a program asks for, and the newest version of glibc that it needs."""
    with tempfile.NamedTemporaryFile() as file:
        file.write(program)
        file.flush()
        if program.startswith(b"MZ"):
            return {name.lower() for name in re.findall(r"DLL Name: (\S+)", said("objdump", "-p", file.name))}, (0, 0)
        told = said("readelf", "--wide", "--dynamic", "--version-info", file.name)
        versions = re.findall(r"Name: GLIBC_(\d+)\.(\d+)", told)
        return set(re.findall(r"\(NEEDED\).*\[(.*)\]", told)), max(((int(one), int(two)) for one, two in versions), default=(0, 0))


def platform_of(name):
    """The key of LIBRARIES for the name of an archive."""
    return next((key for key in ["manylinux", "musllinux", "win_amd64", "windows", "linux"] if key in name), None)


def problems(path):
    """Sentences about faults of an archive, or of a page that contains all of the laboratory."""
    if path.suffix == ".html":
        text = path.read_text(encoding="utf-8")
        yield from (f"{part} is not in it" for part in [NOTICES, *MODULES] if part not in text)
        return
    found = members(path)
    end = next(end for end in CONTENTS if path.name.endswith(end))
    is_command = any(kind in end for kind in ["linux", "windows"])
    for wanted in CONTENTS[end] + (COMMAND if is_command else []):
        if not any(name.endswith(wanted) for name in found):
            yield f"there is no {wanted}"
    programs = {name: contents for name, contents in found.items() if contents[:4] == b"\x7fELF" or contents[:2] == b"MZ"}
    if (is_command or end == ".whl") != bool(programs):
        yield f"it contains {len(programs)} programs"
    for name, contents in programs.items():
        libraries, glibc = imports(contents)
        print(f"  {name} asks for {', '.join(sorted(libraries)) or 'no library'}" + (f", glibc {glibc[0]}.{glibc[1]}" if glibc[0] else ""))
        for library in sorted(libraries):
            if not re.fullmatch(LIBRARIES[platform_of(path.name)], library):
                yield f"{name} asks for {library}, which not every machine has"
        if glibc > GLIBC:
            yield f"{name} needs glibc {glibc[0]}.{glibc[1]}, and {GLIBC[0]}.{GLIBC[1]} is promised"
    if path.name.endswith(".whl"):
        record = next(contents for name, contents in found.items() if name.endswith(".dist-info/RECORD")).decode()
        for name in found:
            if f"{name}," not in record:
                yield f"RECORD does not list {name}"


def main():
    bad = 0
    for path in sorted(Path(sys.argv[1]).iterdir()):
        if path.suffix not in [".gz", ".zip", ".whl", ".html"]:
            continue
        print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB")
        for problem in problems(path):
            bad += 1
            print(f"  WRONG: {problem}")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
