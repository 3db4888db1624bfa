#!/usr/bin/env python3
"""Make what SDCC emits shorter and faster: all of an image's assembly at once, without touching what it does.

usage: tidy FILE.asm ...      (rewritten in place; from the top folder, where the C sources are)

What is written by hand stays as it is (naked functions), and so do functions with a table of jumps or a frame on the stack.
"""
import re
import sys
from pathlib import Path

from asm import Program
from whole import tidy


def volatile_names(files):
    """Every name in a declaration that says volatile."""
    found = set()
    for file in files:
        text = re.sub(r"/\*.*?\*/|//[^\n]*", "", file.read_text(errors="replace"), flags=re.S)
        for declaration in re.findall(r"(?<!asm)\s\bvolatile\b([^;={}]*)", text):
            found |= set(re.findall(r"\w+", declaration))
    return found


def volatile_in(paths):
    """-> {path of an .asm file: names declared volatile in the C file it was made of, or in any header but other processors'}"""
    headers = [header for folder in ("firmware", "boards") for header in Path(folder).rglob("*.h")
               if not header.match("hal/*/*.h") or header.match("mcs51/*")]
    everywhere, found = volatile_names(headers), {}
    for path in paths:
        ends = (Path(*Path(path).parts[n:]).with_suffix(".c") for n in range(len(Path(path).parts)))
        source = next((end for end in ends if end.exists()), None)
        if not source:
            sys.exit(f"{path}: made of no C file here")
        found[path] = everywhere | volatile_names([source])
    return found


def main(paths):
    program = Program(paths, volatile_in(paths))
    tidy(program)
    program.write()
    return 0


if __name__ == "__main__":
    sys.setrecursionlimit(10000)
    sys.exit(main(sys.argv[1:]))
