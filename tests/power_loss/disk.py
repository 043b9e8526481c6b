"""States that a power loss may leave on a disk, of operations that a recorder has noted.

Guaranteed is the content of a file from before its last fsync, and the entries of a folder from before the last fsync of the folder; a
rename is guaranteed by an fsync of the folder into which it leads. Every other operation is on the disk or is not, whatever the order in
which they were issued. A rename is there as a whole or not at all. Of what was written to a file without an fsync there is all; or nothing;
or the length with zeros in it; or the last write alone with zeros before it; or half of the last write.

A state without the newest operation was a state before it, and an fsync makes no new ones: so the states of an operation are those that it
is part of, and of the end of a command all.
"""

import itertools

# The most open entries of folders of which every choice is tried.
ALL_CHOICES_OF = 5


class Disk:
    """Content that is certain to be on the disk: files, which are never changed but replaced, and entries of folders, by number."""

    def __init__(self, tree):
        self.data = {number: bytes(content) for number, content in tree.data.items()}
        self.folders = {number: dict(entries) for number, entries in tree.folders.items()}

    def with_open(self, kept, folders_of_all):
        """The files below folder 0, None for a folder, by their paths, when these operations are there as well."""
        data, folders = dict(self.data), dict(self.folders)
        for operation in kept:
            apply(operation, data, folders, own=False)
        shown = {}

        def walk(folder, prefix):
            for name, child in folders.get(folder, {}).items():
                if child in folders_of_all:
                    shown[prefix + name] = None
                    walk(child, f"{prefix}{name}/")
                else:
                    shown[prefix + name] = data.get(child, b"")

        walk(0, "")
        return shown


def apply(operation, data, folders, own=True):
    """Does an operation; entries that are not our own are replaced and not changed."""

    def entries(folder):
        if not own or folder not in folders:
            folders[folder] = dict(folders.get(folder, {}))
        return folders[folder]

    kind = operation[0]
    if kind == "write":
        _, file, offset, written = operation
        content = data.get(file, b"")
        data[file] = content[:offset].ljust(offset, b"\0") + written + content[offset + len(written) :]
    elif kind == "size":
        _, file, length = operation
        data[file] = data.get(file, b"")[:length].ljust(length, b"\0")
    elif kind == "set":
        entries(operation[1])[operation[2]] = operation[3]
    elif kind == "remove":
        entries(operation[1]).pop(operation[2], None)
    elif kind == "move":
        _, folder, name, to, new_name, child = operation
        if folders.get(folder, {}).get(name) == child:
            del entries(folder)[name]
        entries(to)[new_name] = child


def states(operations, tree, folders_of_all):
    """Every state that a power loss may leave, each once: the number of operations that had been issued, words for what of them is there,
    and the files by their paths, None for a folder. `tree` is what the disk held before."""
    disk, open_now, seen = Disk(tree), [], set()
    yield 0, "as it was", disk.with_open([], folders_of_all)
    for issued, operation in enumerate(operations, 1):
        kind = operation[0]
        if kind == "sync":
            open_now = flushed(disk, open_now, operation[1])
        if kind in ("sync", "say"):
            continue
        if kind != "end":
            open_now.append(operation)
        newest = None if kind == "end" else operation
        for kept, words in choices(open_now, newest):
            shown = disk.with_open(kept, folders_of_all)
            key = hash(frozenset(shown.items())), kind == "end"
            if key not in seen:
                seen.add(key)
                yield issued, words, shown


def flushed(disk, open_now, synced):
    """Makes the open operations of a file or folder certain; returns those that stay open."""
    left, moved = [], set()
    for operation in open_now:
        owner = operation[3] if operation[0] == "move" else operation[1]
        if owner == synced:
            apply(operation, disk.data, disk.folders)
            if operation[0] == "move":
                moved.add((operation[1], operation[2], operation[5]))
        else:
            left.append(operation)
    # A file that has certainly left its folder is not there again.
    return [one for one in left if one[0] != "set" or (one[1], one[2], one[3]) not in moved]


def choices(open_now, newest):
    """Choices of the open operations that may be there, the newest at least in part: operations in order, and words for the choice."""
    entries = [one for one in open_now if one[0] in ("set", "remove", "move")]
    for there in subsets(entries, newest):
        there = {id(one): one for one in there}
        lost = [one for one in entries if id(one) not in there]
        for words, written in contents(open_now, newest):
            both = {**there, **written}
            kept = [both[id(one)] for one in open_now if both.get(id(one)) is not None]
            yield kept, "; ".join(filter(None, [f"lost {lost}" if lost else "", words]))


def subsets(entries, newest):
    """Every choice of a few entries; of many all but one, one, and the first ones; always with the newest."""
    others = [one for one in entries if one is not newest]
    always = [newest] if len(others) < len(entries) else []
    count = len(others)
    if count <= ALL_CHOICES_OF:
        chosen = itertools.chain.from_iterable(itertools.combinations(others, size) for size in range(count, -1, -1))
    else:
        first = [tuple(others[:size]) for size in range(count, -1, -1)]
        chosen = itertools.chain(first, *(itertools.combinations(others, size) for size in (count - 1, 1)))
    return ([*some, *always] for some in chosen)


def contents(open_now, newest):
    """Choices of the open writes: words, and by the operations' identities the operations in their place, None for nothing."""
    writes = [one for one in open_now if one[0] in ("write", "size")]
    whole = {id(one): one for one in writes}
    nothing = {id(one): None for one in writes}
    if not writes:
        yield "", {}
        return
    yield "all written", whole
    if newest is not None and newest[0] in ("write", "size"):
        own = [one for one in writes if one[1] == newest[1]]
        for others, words in ((whole, ""), (nothing, " and nothing of other files")):
            yield f"all written{words}", {**others, **{id(one): one for one in own}}
            for part, kept in parts(own):
                yield part + words, {**others, **kept}
        return
    yield "nothing written", nothing
    files = {one[1]: None for one in writes}
    for file in files:
        own = [one for one in writes if one[1] == file]
        for part, kept in parts(own):
            yield part, {**whole, **kept}
        if len(files) > 1:
            yield "nothing of one file", {**whole, **{id(one): None for one in own}}


def parts(own):
    """Choices of the open writes to one file, but all and nothing."""

    def zeros(one):
        return (*one[:3], bytes(len(one[3]))) if one[0] == "write" else one

    last = own[-1]
    yield "zeros written", {id(one): zeros(one) for one in own}
    if len(own) > 1:
        yield "the last write alone", {**{id(one): zeros(one) for one in own}, id(last): last}
    if last[0] == "write" and len(last[3]) > 1:
        yield "half of the last write", {
            **{id(one): one for one in own},
            id(last): (*last[:3], last[3][: len(last[3]) // 2]),
        }
