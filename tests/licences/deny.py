#!/usr/bin/env python3
"""Holds the crates of all workspaces to the parts [licenses], [bans] and [sources] of deny.toml, as `cargo deny` does.

    tests/licences/deny.py

Advisories are those of `cargo deny` alone. Needs cargo and Python 3.11 or later.
"""

import re
import sys

from crates import REPOSITORY, alternatives, fail, packages, run

# The command with the module for Python and what is only tested, and the command for ranks.
MANIFESTS = ["Cargo.toml", "crates/slipfront-mpi/Cargo.toml"]

CRATES_IO = "https://github.com/rust-lang/crates.io-index"

# The keys that are understood here, with what cargo-deny takes where they are missing: any other fails, lest
# a rule is written that nobody holds. What is only warned of passes.
DEFAULTS = {
    "graph": {"all-features": False},
    "licenses": {"allow": [], "exceptions": []},
    "bans": {"wildcards": "allow", "multiple-versions": "warn", "allow-wildcard-paths": False, "deny": []},
    "sources": {
        "unknown-registry": "warn",
        "unknown-git": "warn",
        "allow-registry": [CRATES_IO],
        "allow-git": [],
    },
}
LEVELS = {"wildcards", "multiple-versions", "unknown-registry", "unknown-git"}


def rules(config):
    """The rules of a deny.toml, with those that it leaves out."""
    for table, keys in config.items():
        if table == "advisories":
            continue
        for key, value in keys.items():
            if key not in DEFAULTS.get(table, {}):
                raise ValueError(f"deny.toml: [{table}] {key} is no rule that tests/licences/deny.py knows; add it there")
            if key in LEVELS and value not in ("allow", "warn", "deny"):
                raise ValueError(f'deny.toml: [{table}] {key} = "{value}" is none of "allow", "warn", "deny"')
    for entry in config.get("licenses", {}).get("exceptions", []):
        if set(entry) != {"crate", "allow"}:
            raise ValueError(f"deny.toml: the exception {entry} must have `crate` and `allow`, and nothing else")
    for entry in config.get("bans", {}).get("deny", []):
        if not {"crate"} <= set(entry) <= {"crate", "reason"} or not re.fullmatch(r"[\w-]+", entry["crate"]):
            raise ValueError(f"deny.toml: the ban {entry} must name a crate without a version, and may give a reason")
    return {table: {**keys, **config.get(table, {})} for table, keys in DEFAULTS.items()}


def wrong_licences(package, rule):
    """Errors in the licences of a package."""
    if not package["license"]:
        return ["declares no licence"]
    allowed = set(rule["allow"])
    for entry in rule["exceptions"]:
        if entry["crate"] == package["name"]:
            allowed.update(entry["allow"])
    try:
        if any(licences <= allowed for licences in alternatives(package["license"])):
            return []
    except ValueError as error:
        return [f"has the licence {error}"]
    return [f"has the licence {package['license']}, which needs one that is not allowed"]


def wrong_bans(package, rule):
    """Errors in the name of a package and in the versions that it asks for."""
    wrong = [
        f"is banned: {entry.get('reason', 'no reason is given')}" for entry in rule["deny"] if entry["crate"] == package["name"]
    ]
    if rule["wildcards"] == "deny":
        # What the tests of a crate need of a folder is left out where the crate is packed.
        def is_excepted(needed):
            return rule["allow-wildcard-paths"] and needed.get("kind") == "dev" and "path" in needed

        wrong += [
            f"asks for any version of {needed['name']}"
            for needed in package["dependencies"]
            if needed["req"] == "*" and not is_excepted(needed)
        ]
    return wrong


def wrong_sources(package, rule):
    """Errors in the source of a package: crates of this repository come from no other."""
    if package["source"] is None:
        return []
    kind, _, address = package["source"].partition("+")
    address = address.partition("?")[0].partition("#")[0]
    known, level = {
        "registry": (rule["allow-registry"], rule["unknown-registry"]),
        "sparse": (rule["allow-registry"], rule["unknown-registry"]),
        "git": (rule["allow-git"], rule["unknown-git"]),
    }.get(kind, ([], "deny"))
    return [f"comes from {package['source']}"] if level == "deny" and address not in known else []


def twice(found, rule):
    """The packages that are there in several versions, where that is denied."""
    versions = {}
    for package in found:
        versions.setdefault(package["name"], set()).add(package["version"])
    if rule["multiple-versions"] != "deny":
        return []
    return [f"{name} is there in versions {', '.join(sorted(them))}" for name, them in versions.items() if len(them) > 1]


def judge(found, rule):
    """Everything that is wrong with these packages, in sentences."""
    wrong = []
    for package in found:
        sentences = (
            wrong_licences(package, rule["licenses"])
            + wrong_bans(package, rule["bans"])
            + wrong_sources(package, rule["sources"])
        )
        wrong += [f"{package['name']} {package['version']} {sentence}" for sentence in sentences]
    return wrong + twice(found, rule["bans"])


def main():
    try:
        import tomllib
    except ModuleNotFoundError:
        fail(f"deny.toml is read with tomllib, which Python has from 3.11 on; this is {sys.version.split()[0]}")
    try:
        rule = rules(tomllib.loads((REPOSITORY / "deny.toml").read_text("utf-8")))
    except tomllib.TOMLDecodeError as error:
        fail(f"deny.toml: {error}")
    features = ["--all-features"] if rule["graph"]["all-features"] else []
    wrong, names = [], set()
    for manifest in MANIFESTS:
        found = packages(manifest, *features)
        names |= {package["name"] for package in found}
        wrong += [f"{sentence} ({manifest})" for sentence in judge(found, rule)]
    wrong += [
        f"deny.toml makes an exception for {entry['crate']}, which is not used any more"
        for entry in rule["licenses"]["exceptions"]
        if entry["crate"] not in names
    ]
    if wrong:
        fail("deny.toml is not kept:\n" + "\n".join(wrong))
    print(f"licences, bans and sources of {len(names)} crates are those that deny.toml allows")


if __name__ == "__main__":
    run(main)
