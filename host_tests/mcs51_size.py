#!/usr/bin/env python3
"""What 8051 images take, against their board's budget.

usage: mcs51_size.py [--paths] [--budget FILE] build/BOARD/IMAGE.ihx ...      FILE: boards/BOARD/budget.txt

A row of the budget is an image and five figures, each the most there may be; other rows belong to other tests.

  code    octets of program memory
  XDATA   octets of external RAM
  IDATA   octets of internal RAM below the stack: register banks, variables, bits, what SDCC's library and overlays take
  bits    bit-addressable ones of them, of 128
  stack   octets at the deepest, by the calls (stack51.py); must fit the room that the linker has left, too

An image that has no row fails. --paths prints the calls to the deepest stack.
"""
import re
import sys
from pathlib import Path

from asm51 import load
from stack51 import Stack, Unknown

COLUMNS = ("code", "XDATA", "IDATA", "bits", "stack")


def rows(budget):
    """-> {image: limits}"""
    lines = (line.split("#")[0].split() for line in Path(budget).read_text().splitlines())
    return {words[0]: dict(zip(COLUMNS, map(int, words[1:]))) for words in lines if len(words) == len(COLUMNS) + 1}


def taken(image, stack):
    mem = image.ihx.with_suffix(".mem").read_text()
    code = re.search(r"ROM/EPROM/FLASH\s+0x\w+\s+0x\w+\s+(\d+)", mem)[1]
    xram = re.findall(r"(?:PAGED EXT\. RAM|EXTERNAL RAM)\s+(?:0x\w+\s+0x\w+\s+)?(\d+)", mem)
    return dict(zip(COLUMNS, (int(code), sum(map(int, xram)), image.stack_start, image.sizes["BSEG"], stack.worst)))


def report(ihx, budget, paths):
    """Print the row of one image -> is it within the budget?"""
    ihx = Path(ihx)
    name = f"{ihx.parent.name}/{ihx.stem}"
    limits = rows(budget or f"boards/{ihx.parent.name}/budget.txt").get(ihx.stem)
    if limits is None:
        print(f"{name:26s} has no row in the budget")
        return False
    try:
        program = load(ihx)
        stack = Stack(program)
    except Unknown as unknown:
        print(f"{name:26s} {unknown}")
        return False
    found = taken(program.image, stack)
    wrong = [f"{column} over budget" for column in COLUMNS if found[column] > limits[column]]
    if stack.worst > program.image.stack_room:
        wrong.append("stack runs out of internal RAM")
    print(f"{name:26s} " + " ".join(f"{found[c]:>5d} /{limits[c]:>5d}" for c in COLUMNS)
          + f" of {program.image.stack_room} left  " + ", ".join(wrong))
    if paths:
        parts = [stack.main, *stack.levels.values()]
        print("".join(f"    {octets:3d}  {' > '.join(calls)}\n" for octets, calls in zip(parts, stack.paths)), end="")
    return not wrong


def main(arguments):
    budget, paths = None, arguments[:1] == ["--paths"]
    arguments = arguments[paths:]
    if arguments[:1] == ["--budget"]:
        budget, arguments = arguments[1], arguments[2:]
    print(f"{'8051 image / budget':26s} " + " ".join(f"{column:>12s}" for column in COLUMNS))
    good = [report(ihx, budget, paths) for ihx in arguments]
    return 0 if good and all(good) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
