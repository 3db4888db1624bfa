#!/usr/bin/env python3
"""Call and jump in two octets, not three, where the target lies in the same 2 kB page.

usage: near.py [--check] IMAGE.map FILE ...      FILE.rst: as linked; FILE.asm: rewritten in place

lcall and ljmp of the code area become acall and ajmp; vectors and start-up stay as they are. What the linked image has
where stands in its listings (.rst). Each change moves what lies behind it, so all are supposed made first, and whichever
then crosses a page is given up, until none does; the same files always give the same result. --check reads the listings
of the image linked again: does each acall and ajmp name the page of its target?
"""
import re
import sys
from bisect import bisect_left
from pathlib import Path

ROW = re.compile(r"^ {6}([0-9A-F]{6}) ?((?:[0-9A-F]{2} )*)\s*(?:\[\d+\])?\s*(\d+) (.*)$")
ROW_NO_ADDRESS = re.compile(r"^\s+(\d+) (\s*\.area\s+(\w+).*)$")
LABEL = re.compile(r"^\s*(\w+\$?)::?(\s|$)")
FAR = re.compile(r"^\s*(lcall|ljmp|acall|ajmp)\s+(\w+\$?)\s*(?:;.*)?$")
NEAR = {"lcall": "acall", "ljmp": "ajmp"}


class Transfer:
    """One call or jump: where it stands (file, line, address) and the address it leads to."""

    def __init__(self, file, line, at, op, target):
        self.file, self.line, self.at, self.op, self.target = file, line, at, op, target


def listed(file, exported):
    """-> transfers of one listing; a target that is not in the file is looked for among the exported addresses"""
    found, labels, function, area = [], dict(), "", ""
    for text in Path(f"{file}.rst").read_text().splitlines():
        no_address = ROW_NO_ADDRESS.match(text)
        if no_address:
            area = no_address[3]
        row = ROW.match(text)
        if not row or area != "CSEG":
            continue
        at, line, source = int(row[1], 16), int(row[3]), row[4]
        label, far = LABEL.match(source), FAR.match(source)
        if label and label[1].endswith("$"):
            labels[function, label[1]] = at
        elif label:
            function = label[1]
            labels["", function] = at
        elif far:
            found.append(Transfer(file, line, at, far[1], (function if far[2].endswith("$") else "", far[2])))
    for transfer in found:
        transfer.target = labels.get(transfer.target, exported.get(transfer.target[1]))
    return [transfer for transfer in found if transfer.target is not None]


def same_page(transfer, moved):
    return (moved(transfer.at) + 2) >> 11 == moved(transfer.target) >> 11


def choose(transfers):
    """-> those that can be near, all together"""
    near = [t for t in transfers if t.op in NEAR]
    while True:
        starts = sorted(t.at for t in near)
        kept = [t for t in near if same_page(t, lambda at: at - bisect_left(starts, at))]
        if len(kept) == len(near):
            return near
        near = kept


def rewrite(near):
    for file in sorted({t.file for t in near}):
        lines = Path(f"{file}.asm").read_text().splitlines(keepends=True)
        for t in near:
            if t.file == file:
                lines[t.line - 1] = lines[t.line - 1].replace(t.op, NEAR[t.op], 1)
        Path(f"{file}.asm").write_text("".join(lines))


def main(arguments):
    check = arguments[:1] == ["--check"]
    image, *files = arguments[check:]
    exported = {name: int(at, 16) for at, name in re.findall(r"^C:\s+([0-9A-F]{8})\s+(_\w+)", Path(image).read_text(), re.M)}
    transfers = [t for file in files for t in listed(file, exported)]
    if not check:
        rewrite(choose(transfers))
        return 0
    wrong = [t for t in transfers if t.op in NEAR.values() and not same_page(t, lambda at: at)]
    for t in wrong:
        print(f"{t.file}.asm:{t.line}: {t.op} from {t.at:04X} cannot lead to {t.target:04X}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
