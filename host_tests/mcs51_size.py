#!/usr/bin/env python3
"""What an 8051 image takes, against its board's budget.

usage: mcs51_size.py boards/BOARD/budget.txt      reads build/BOARD/IMAGE.mem, which the linker wrote
"""
import re
import sys
from pathlib import Path


def taken(mem):
    text = Path(mem).read_text()
    code = int(re.search(r"ROM/EPROM/FLASH\s+0x\w+\s+0x\w+\s+(\d+)", text)[1])
    xram = sum(int(n) for n in re.findall(r"(?:PAGED EXT\. RAM|EXTERNAL RAM)\s+0x\w+\s+0x\w+\s+(\d+)", text))
    stack, left = re.search(r"Stack starts at: 0x(\w+).*with (\d+) bytes", text).groups()
    return code, xram, int(stack, 16), int(left)


def main(budget):
    board, over = Path(budget).parent.name, False
    print(f"{'image':24s} {'code':>6s} {'XDATA':>6s} {'IDATA':>6s} {'stack':>6s}   (budget)")
    for line in Path(budget).read_text().splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        image, *limits = line.split()
        limits = [int(n) for n in limits]
        found = taken(f"build/{board}/{image}.mem")
        good = all(n <= limit for n, limit in zip(found[:3], limits)) and found[3] >= limits[3]
        over |= not good
        print(f"{board + '/' + image:24s} {found[0]:6d} {found[1]:6d} {found[2]:6d} {found[3]:6d}   "
              f"({', '.join(map(str, limits))}) {'' if good else 'OVER BUDGET'}")
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
