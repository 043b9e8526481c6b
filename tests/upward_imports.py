#!/usr/bin/env python3
"""Imports that run upward inside of a crate: a module that takes an item which the file of a module around it defines.

    tests/upward_imports.py

Such an item belongs into a module of its own below both, else the file around cannot be read before those inside of it.
Test modules are left out; names that the file around passes on from another module (`pub use`) are no items of its own.
Of Python it is a file that imports from the package around it, and not from the file beside it. Fails if there is one.
"""

import re
import subprocess
import sys
from pathlib import Path

ITEM = re.compile(
    r"^(?:pub(?:\([a-z ]+\))? )?(?:const |async |unsafe )*"
    r"(?:fn|struct|enum|const|static|trait|type|union|macro_rules!) (?:mut )?(\w+)",
    re.M,
)
IMPORT = re.compile(r"^(?:pub(?:\([a-z ]+\))? )?use ((?:crate|self|super)\b[^;]*);", re.M)
# A path in the text of a function, such as `super::limit(...)`.
PATH = re.compile(r"(?<![\w:])((?:crate|super)(?:::\w+)+)")


def code_of(path):
    """The text of a file without comments, and without the test modules at its end."""
    text = path.read_text().split("\n#[cfg(test)]\nmod ")[0]
    return re.sub(r"^\s*//.*$|(?<=[;,{]) //.*$", "", text, flags=re.M)


def module_of(root, path):
    """The module that a file is, as the names from the crate down."""
    parts = list(path.relative_to(root).with_suffix("").parts)
    return tuple(parts[:-1] if parts[-1] in ("mod", "lib", "main") else parts)


def leaves(tree):
    """The paths that a `use` names: `a::{b, c::d}` gives `a::b` and `a::c::d`."""
    tree = re.sub(r"\s+", " ", tree).strip()
    head, brace, rest = tree.partition("{")
    if not brace:
        return [tree.split(" as ")[0].strip()]
    parts, depth, part = [], 0, ""
    for letter in rest[: rest.rindex("}")]:
        if letter == "," and depth == 0:
            parts.append(part)
            part = ""
        else:
            depth += (letter == "{") - (letter == "}")
            part += letter
    parts.append(part)
    return [head + leaf for part in parts if part.strip() for leaf in leaves(part)]


def resolved(module, path):
    """The module and the name of an imported path, from the crate down."""
    names = path.split("::")
    if names[0] == "crate":
        names = names[1:]
    elif names[0] == "self":
        names = list(module) + names[1:]
    else:
        base = list(module)
        while names and names[0] == "super":
            base, names = base[:-1], names[1:]
        names = base + names
    return tuple(names[:-1]), names[-1] if names else ""


def upward(root):
    """Sentences about the upward imports below `root`."""
    files = {}
    for path in sorted(root.rglob("*.rs")):
        if path.name not in ("tests.rs", "for_tests.rs", "testing.rs") and "tests" not in path.relative_to(root).parts:
            files[module_of(root, path)] = path
    items = {module: set(ITEM.findall(code_of(path))) for module, path in files.items()}
    for module, path in files.items():
        code = code_of(path)
        named = {leaf for tree in IMPORT.findall(code) for leaf in leaves(tree)}
        named |= set(PATH.findall(IMPORT.sub("", code)))
        for leaf in sorted(named):
            target, name = resolved(module, leaf)
            # A longer path, such as that of a variant or a method, names its item before the end.
            while target not in files and target:
                target, name = target[:-1], target[-1]
            if target == module[: len(target)] and target != module and (name in items.get(target, ()) or name == "*"):
                around = "::".join(target) or "the crate's own file"
                yield f"{path}: `{name}` is defined in {around}, which lies around this module"


def upward_in_python(folder):
    """Sentences about the upward imports of the files of a Python package."""
    for path in sorted(folder.glob("_*.py")):
        if path.name != "__init__.py" and re.search(r"^\s*from (?:\.|slipfront) import ", path.read_text(), re.M):
            yield f"{path}: imports from the package around it; name the file: `import slipfront._case as _case`"


def main():
    listed = subprocess.run(["git", "ls-files", "*/src/lib.rs"], capture_output=True, text=True, check=True)
    roots = [Path(name).parent for name in listed.stdout.split()]
    found = [sentence for root in roots for sentence in upward(root)]
    found += upward_in_python(Path("python/slipfront"))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)


main()
