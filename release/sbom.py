#!/usr/bin/env python3
"""Lists what a program contains, crates and other parts, as CycloneDX 1.5, in JSON that is held against the schema:

    release/sbom.py PACKAGE TARGET FILE

PACKAGE is the folder of a crate, TARGET a platform as Rust names it. Needs cargo, Python 3.11 and cyclonedx-python-lib.
"""

import json
import os
import sys
import time
import tomllib
from pathlib import Path

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests/licences"))
from crates import REPOSITORY, cargo, fail, packages, run
from notices import MUSL, PARTS, feature_options, linked


def checksums():
    """The SHA-256 of the packages of other crates, by name and version."""
    locked = tomllib.loads((REPOSITORY / "Cargo.lock").read_text())["package"]
    return {(package["name"], package["version"]): package["checksum"] for package in locked if "checksum" in package}


def component(package, checksum):
    """Entry of a crate: name, version, licences, and the checksum of its package if it is one of others."""
    address = f"pkg:cargo/{package['name']}@{package['version']}"
    hashes = {"hashes": [{"alg": "SHA-256", "content": checksum}]} if checksum else {}
    return {
        **hashes,
        "type": "library",
        "bom-ref": address,
        "name": package["name"],
        "version": package["version"],
        "purl": address,
        # Crates of before 2018 may have a slash in place of OR.
        "licenses": [{"expression": package["license"].replace("/", " OR ")}],
    }


def sbom(folder, target, seconds):
    """The list of the crates that are compiled into the program of a folder."""
    manifest = f"{folder}/Cargo.toml"
    options = feature_options(folder, [target])
    known = {(package["name"], package["version"]): package for package in packages(manifest, *options)}
    sums = checksums()
    inside = {crate: component(known[crate], sums.get(crate)) for crate in sorted(linked(folder, [target]))}
    metadata = json.loads(cargo("metadata", manifest, "--format-version=1", f"--filter-platform={target}", *options))
    by_id = {package["id"]: (package["name"], package["version"]) for package in metadata["packages"]}
    dependencies = []
    for node in metadata["resolve"]["nodes"]:
        if by_id[node["id"]] in inside:
            # Normal dependencies have the kind null.
            normal = {by_id[one["pkg"]] for one in node["deps"] if any(kind["kind"] is None for kind in one["dep_kinds"])}
            needed = sorted(inside[crate]["bom-ref"] for crate in normal if crate in inside)
            dependencies.append({"ref": inside[by_id[node["id"]]]["bom-ref"], "dependsOn": needed})
    parts = {**PARTS, **MUSL} if "musl" in target else PARTS
    program = next(crate for crate in inside if known[crate]["manifest_path"].endswith(f"/{manifest}"))
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "timestamp": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds)),
            "component": {**inside.pop(program), "type": "application"},
            "properties": [{"name": "slipfront:platform", "value": target}],
        },
        "components": [*inside.values(), *({"type": "library", "name": part} for part in parts)],
        "dependencies": sorted(dependencies, key=lambda one: one["ref"]),
    }


def main():
    folder, target, file = sys.argv[1:]
    text = json.dumps(sbom(folder, target, int(os.environ["SOURCE_DATE_EPOCH"])), indent=1) + "\n"
    if error := JsonStrictValidator(SchemaVersion.V1_5).validate_str(text):
        fail(f"the list of crates is no CycloneDX 1.5: {error}")
    Path(file).write_text(text)


if __name__ == "__main__":
    run(main)
