"""Recorder of all that a command does to the files below a folder, as strace tells it.

A record is a list of operations on numbered files and folders, in the order in which the system finished them:

    ("write", file, offset, bytes)      ("size", file, length)              ("sync", file or folder)
    ("set", folder, name, child)        ("remove", folder, name)            ("move", folder, name, folder, name, child)
    ("say", text)                       a line on stderr; ("end", status)   the end of a command
"""

import os
import re
import subprocess

from disk import apply

CALLS = """open openat creat close write pwrite64 writev lseek ftruncate truncate fallocate rename renameat renameat2 link linkat
symlink symlinkat unlink unlinkat rmdir mkdir mkdirat fsync fdatasync sync syncfs sync_file_range copy_file_range sendfile dup dup2 dup3
fcntl mmap"""

LINE = re.compile(r"^(\d+) +(\w+)\((.*)\) += (-?\d+|0x[0-9a-f]+|\?)( .*)?$")
UNFINISHED = re.compile(r"^(\d+) +(\w+\(.*) <unfinished \.\.\.>$")
RESUMED = re.compile(r"^(\d+) +<\.\.\. \w+ resumed>(.*)$")


class Tree:
    """Files and folders by number. Folder 0 is the one below which operations are recorded."""

    def __init__(self, root):
        self.root = os.path.realpath(root)
        self.data = {}
        self.folders = {}
        self._read(self.root)

    def _read(self, path):
        number = len(self.data) + len(self.folders)
        if os.path.isdir(path):
            entries = self.folders[number] = {}
            for name in sorted(os.listdir(path)):
                entries[name] = self._read(os.path.join(path, name))
        else:
            with open(path, "rb") as file:
                self.data[number] = file.read()
        return number

    def new(self, is_folder):
        number = len(self.data) + len(self.folders)
        if is_folder:
            self.folders[number] = {}
        else:
            self.data[number] = b""
        return number

    def parts(self, path):
        """The names from the root to a path; none outside of it."""
        relative = os.path.relpath(path, self.root)
        if relative == "." or relative.startswith(".."):
            return [] if relative == "." else None
        return relative.split("/")

    def find(self, parts):
        """The number of a file or folder, none where there is nothing."""
        number = 0
        for part in parts:
            number = self.folders.get(number, {}).get(part)
            if number is None:
                return None
        return number

    def place(self, parts):
        """The folder of a path, and its name there."""
        return self.find(parts[:-1]), parts[-1]


class Recorder:
    """Records commands one after the other, which work in one folder."""

    def __init__(self, root):
        self.tree = Tree(root)
        self.operations = []

    def run(self, command, meanwhile=lambda process: None):
        """Runs a command in the folder; returns its status and what it has printed. `meanwhile` gets the process of strace."""
        trace = self.tree.root + ".strace"
        strace = ["strace", "-f", "-xx", "-s", "999999999", "-e", "signal=none", "-e", f"trace={','.join(CALLS.split())}", "-o", trace]
        process = subprocess.Popen(
            strace + command, cwd=self.tree.root, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        meanwhile(process)
        out, err = process.communicate()
        self._read(trace)
        os.remove(trace)
        self.operations.append(("end", process.returncode))
        return process.returncode, out, err

    def _read(self, trace):
        # Open files by the numbers of the system, and their paths when they were opened.
        self.open = {1: ("terminal",), 2: ("terminal",)}
        self.where = {}
        begun = {}
        with open(trace, encoding="ascii") as file:
            for line in file:
                line = line.rstrip("\n")
                if match := UNFINISHED.match(line):
                    begun[match[1]] = match[2]
                    continue
                if match := RESUMED.match(line):
                    line = f"{match[1]} {begun.pop(match[1])}{match[2]}"
                if match := LINE.match(line):
                    if match[4] != "?" and int(match[4], 0) >= 0:
                        self._call(match[2], arguments(match[3]), int(match[4], 0))
                elif not re.match(r"^\d+ +(\+\+\+|---)", line):
                    raise ValueError(f"a line of strace that is not understood: {line[:300]}")

    def _do(self, *operation):
        """Notes an operation, and does it to the tree of what the system shows."""
        self.operations.append(operation)
        apply(operation, self.tree.data, self.tree.folders)

    def _whole(self, folder, path):
        """A path from the root of all; the folder is the number of an open one, or AT_FDCWD."""
        base = self.tree.root if folder == "AT_FDCWD" else self.where.get(int(folder), "/outside")
        return os.path.normpath(os.path.join(base, os.fsdecode(path)))

    def _parts(self, folder, path):
        """The names of a path below the root, none elsewhere."""
        return self.tree.parts(self._whole(folder, path))

    def _call(self, name, given, result):
        if name in ("open", "creat"):
            given = ["AT_FDCWD", *given]
        if name in ("open", "openat", "creat"):
            self._opened(given, "O_CREAT|O_TRUNC|O_WRONLY" if name == "creat" else given[2], result)
        elif name in ("rename", "renameat", "renameat2"):
            given = ["AT_FDCWD", given[0], "AT_FDCWD", given[1]] if name == "rename" else given
            self._renamed(self._parts(given[0], given[1]), self._parts(given[2], given[3]))
        elif name in ("mkdir", "mkdirat"):
            if parts := self._parts(*(["AT_FDCWD", given[0]] if name == "mkdir" else given[:2])):
                folder, own = self.tree.place(parts)
                self._do("set", folder, own, self.tree.new(True))
        elif name in ("unlink", "rmdir", "unlinkat"):
            if parts := self._parts(*(given[:2] if name == "unlinkat" else ["AT_FDCWD", given[0]])):
                self._do("remove", *self.tree.place(parts))
        elif name in ("sync", "syncfs"):
            raise ValueError("the command syncs a whole disk")
        elif name in ("link", "linkat", "symlink", "symlinkat", "truncate", "dup", "dup2", "dup3"):
            if any(isinstance(one, bytes) and self._parts("AT_FDCWD", one) for one in given):
                raise ValueError(f"a call that is not understood: {name} {given}")
        elif name == "fcntl":
            if given[1].startswith("F_DUPFD") and int(given[0]) in self.open:
                self.open[result] = self.open[int(given[0])]
        elif name == "mmap":
            if "MAP_SHARED" in given[3] and "PROT_WRITE" in given[2] and int(given[4]) in self.open:
                raise ValueError("the command writes to a file through memory")
        else:
            self._of_open(name, given, result)

    def _opened(self, given, flags, number):
        path = self.where[number] = self._whole(given[0], given[1])
        parts = self.tree.parts(path)
        if parts is None:
            self.open[number] = ["outside", path, 0]
            return
        found = self.tree.find(parts)
        if found is None:
            found = self.tree.new(False)
            folder, own = self.tree.place(parts)
            self._do("set", folder, own, found)
        elif "O_TRUNC" in flags and self.tree.data[found]:
            self._do("size", found, 0)
        self.open[number] = ["file", found, 0, "O_APPEND" in flags]

    def _renamed(self, one, other):
        if one is None and other is None:
            return
        if one is None or other is None:
            raise ValueError("a file is renamed into the folder or out of it")
        child = self.tree.find(one)
        self._do("move", *self.tree.place(one), *self.tree.place(other), child)

    def _of_open(self, name, given, result):
        """A call on an open file."""
        is_copy = name in ("copy_file_range", "sendfile")
        number = int(given[2] if name == "copy_file_range" else given[0])
        if name == "close":
            self.open.pop(number, None)
            return
        file = self.open.get(number)
        if file is None or (file[0] == "outside" and not is_copy):
            return
        if file[0] == "terminal":
            if number == 2 and name == "write":
                self.operations.append(("say", given[1].decode(errors="replace")))
            return
        if name in ("fsync", "fdatasync"):
            self.operations.append(("sync", file[1]))
        elif name == "lseek":
            file[2] = result
        elif name == "ftruncate":
            self._do("size", file[1], int(given[1]))
        elif name == "write":
            self._write(file, given[1][:result])
        elif name == "pwrite64":
            self._do("write", file[1], int(given[3]), given[1][:result])
        elif is_copy:
            source = self.open[int(given[0] if name == "copy_file_range" else given[1])]
            if result:
                self._write(file, self._copied(source, result))
        else:
            raise ValueError(f"a call that is not understood: {name} {given}")

    def _write(self, file, data):
        offset = len(self.tree.data[file[1]]) if file[3] else file[2]
        before = self.operations[-1] if self.operations else ("none",)
        if before[0] == "write" and before[1] == file[1] and before[2] + len(before[3]) == offset:
            # Writes that follow one another are one, which may be torn.
            self.operations[-1] = (*before[:3], before[3] + data)
            apply(("write", file[1], offset, data), self.tree.data, self.tree.folders)
        else:
            self._do("write", file[1], offset, data)
        file[2] = offset + len(data)

    def _copied(self, source, length):
        """Bytes that the system copies from an open file without showing them; files outside of the folder do not change."""
        if source[0] == "file":
            data = self.tree.data[source[1]]
        else:
            with open(source[1], "rb") as file:
                data = file.read()
        source[2] += length
        return data[source[2] - length : source[2]]


def arguments(text):
    """The arguments of a call: strings as bytes, all else as text."""
    found, depth, start, quoted = [], 0, 0, False
    for place, sign in enumerate(text + ","):
        if sign == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif sign in "[{(":
            depth += 1
        elif sign in "]})":
            depth -= 1
        elif sign == "," and depth == 0:
            found.append(text[start:place].strip())
            start = place + 1
    return [bytes.fromhex(one[1:-1].replace("\\x", "")) if one.startswith('"') and one.endswith('"') else one for one in found]
