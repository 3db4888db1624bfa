#!/usr/bin/env python3
"""Leave out the functions of an image that nothing calls.

usage: strip_unused.py FILE.asm ...      (all of one image; rewritten in place)

SDCC and its linker keep or drop whole files; on a part with 16 kB that is too coarse. A function's text begins at its
global or static label in the code area and ends before the next one. It stays if main, an interrupt vector, start-up
code, a constant table or a function that stays names it. Labels of other files are known by their names only, so a
static function counts as used when its own file names it.
"""
import re
import sys
from pathlib import Path

LABEL = re.compile(r"^(_\w+)::?\s*$")
NAME = re.compile(r"(?<![\w.])_\w+")
CODE_AREAS = ("CSEG", "HOME")


def split(text):
    """-> [(label or None, [lines])]: pieces of the file in order; label for functions."""
    pieces, label, lines, area = [], None, [], ""
    for line in text.splitlines(keepends=True):
        words = line.split()
        if words[:1] == [".area"]:
            pieces.append((label, lines))
            label, lines, area = None, [], words[1]
        found = LABEL.match(line.rstrip())
        if found and area in CODE_AREAS:
            pieces.append((label, lines))
            label, lines = found.group(1), []
        lines.append(line)
    pieces.append((label, lines))
    return pieces


def names(lines):
    found = set()
    for line in lines:
        line = line.split(";")[0]
        if not line.strip().startswith(".globl") and not LABEL.match(line.rstrip()):
            found |= set(NAME.findall(line))
    return found


def main(paths):
    files = {path: split(Path(path).read_text()) for path in paths}
    functions = {}  # (path or None, label) -> piece; path None: visible to all files
    for path, pieces in files.items():
        exported = set(re.findall(r"^\s*\.globl\s+(_\w+)", Path(path).read_text(), re.M))
        for label, lines in pieces:
            if label:
                functions[(None if label in exported else path, label)] = (path, lines)

    def resolve(path, name):
        return (path, name) if (path, name) in functions else (None, name)

    # names that begin with two underscores are the compiler's: vectors and start-up
    work = [(None, "_main")] + [key for key in functions if key[1].startswith("__")]
    for path, pieces in files.items():
        for label, lines in pieces:
            if not label:
                work += [resolve(path, n) for n in names(lines)]
    used = set()
    while work:
        key = work.pop()
        if key in used or key not in functions:
            continue
        used.add(key)
        path, lines = functions[key]
        work += [resolve(path, n) for n in names(lines)]
    unused = {label for path, label in functions if path is None and (path, label) not in used}
    for path, pieces in files.items():
        gone = {label for label, _ in pieces if label and resolve(path, label) not in used}
        text = ""
        for label, lines in pieces:
            # register names are set where they are used first, for the rest of the file
            text += "".join(line for line in lines if label not in gone or re.match(r"\s+ar\d = ", line))
        text = "".join(line for line in text.splitlines(keepends=True)
                       if not (line.split()[:1] == [".globl"] and line.split()[1] in unused))
        Path(path).write_text(text)
        if gone:
            print(f"{path}: without {', '.join(sorted(n[1:] for n in gone))}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
