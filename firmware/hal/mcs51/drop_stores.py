#!/usr/bin/env python3
"""Drop what SDCC stores in external RAM only to load it again at once.

usage: drop_stores.py FILE.asm ...      (rewritten in place)

In the large model SDCC 4.2 gives each argument a place in external RAM, writes it there on entry and reads it back in
the next instruction, even where a register is all the function needs:

    mov a,dpl / mov dptr,#_f_x_65536_12 / movx @dptr,a / movx a,@dptr / mov r7,a

The load goes: the value is still in A. Where no load of that place is left, the store goes as well, unless somebody
uses DPTR behind it. A place is the static symbol of one function (_f_x_65536_12), and no local here is volatile.
"""
import re
import sys
from pathlib import Path

PLACE = re.compile(r"^(_\w+_\d+_\d+):$")
USES_DPTR = re.compile(r"^inc dptr|@dptr|@a\+dptr|[ ,(]dp[lh]\b")
SETS_DPTR = re.compile(r"^(mov dptr,|(lcall|acall|ret|reti)\b)")  # a call's argument, a return's value: set for it
SETS_HALF = re.compile(r"^(mov dp[lh],(?!dp[lh])|pop dp[lh])")
JUMP = re.compile(r"^(?:[sla]jmp|jn?[cz]|jn?b|jbc|cjne|djnz)\b.*?(\w+\$?)$")


class Listing:
    """The lines of a file; code[i] is the i-th instruction or label in them, in one spelling."""

    def __init__(self, text):
        self.lines = text.splitlines(keepends=True)
        self.read()

    def read(self):
        self.at, self.code = [], []
        for number, line in enumerate(self.lines):
            text = re.sub(r"\s*,\s*", ",", " ".join(line.split(";")[0].split()))
            if text:
                self.at.append(number)
                self.code.append(text)

    def replace(self, first, count, instructions):
        """count instructions from the first on; comments between them go."""
        self.lines[self.at[first]:self.at[first + count - 1] + 1] = [f"\t{i}\n" for i in instructions]
        self.read()

    def label(self, name, near):
        """Index of a local label (00101$) of the function around instruction `near`, None: not there."""
        for way in (range(near, len(self.code)), range(near, -1, -1)):
            for i in way:
                if self.code[i] == name + ":":
                    return i
                if re.match(r"_\w+:", self.code[i]):
                    break
        return None

    def dptr_is_free(self, start):
        """From instruction `start` on DPTR is set before it is used, whatever way is taken."""
        seen, work = set(), [start]
        while work:
            i = work.pop()
            if i in seen or i >= len(self.code) or SETS_DPTR.match(self.code[i]):
                continue
            seen.add(i)
            if USES_DPTR.search(self.code[i]) and not SETS_HALF.match(self.code[i]):
                return False
            jump = JUMP.match(self.code[i])
            if jump and jump[1].endswith("$"):
                target = self.label(jump[1], i)
                if target is None:
                    return False
                work.append(target)
            if not re.match(r"[sla]jmp\b", self.code[i]):
                work.append(i + 1)
        return True


def drop_loads(listing, place):
    load = f"mov dptr,#{place}"
    for i in range(len(listing.code) - 1, -1, -1):
        code = listing.code[i:i + 11]
        if code[:3] == [load, "movx @dptr,a", "movx a,@dptr"]:
            listing.replace(i, 3, code[:2])
        elif len(code) == 11 and code[:2] + code[3:7] + code[8:10] == [
                load, "movx @dptr,a", "inc dptr", "movx @dptr,a", load, "movx a,@dptr", "inc dptr", "movx a,@dptr"]:
            high, low_to, high_to = (re.fullmatch(pattern, code[n]) for pattern, n in
                                     ((r"mov a,(r\d)", 2), (r"mov (r\d),a", 7), (r"mov (r\d),a", 10)))
            if high and low_to and high_to and low_to[1] != high[1]:
                listing.replace(i, 11, [code[7]] + code[:5] + ([code[10]] if high_to[1] != high[1] else []))


def drop_stores(listing, place):
    uses = [i for i, text in enumerate(listing.code) if re.search(rf"\b{place}\b", text) and text != place + ":"]
    sizes = []
    for i in uses:
        code = listing.code[i:i + 5]
        if code[:2] != [f"mov dptr,#{place}", "movx @dptr,a"]:
            return
        word = code[3:] == ["inc dptr", "movx @dptr,a"] and code[2].startswith("mov a,")
        sizes.append(5 if word else 2)
        if not listing.dptr_is_free(i + sizes[-1]):
            return
    for i, size in reversed(list(zip(uses, sizes))):
        listing.replace(i, size, [listing.code[i + 2]] if size == 5 else [])


def main(paths):
    for path in paths:
        listing = Listing(Path(path).read_text())
        for name in filter(None, map(PLACE.match, listing.code)):
            drop_loads(listing, name[1])
            drop_stores(listing, name[1])
        Path(path).write_text("".join(listing.lines))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
