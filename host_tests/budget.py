#!/usr/bin/env python3
"""What the images of the gcc boards take, beside boards/BOARD/budget.txt: a figure above its limit is a failure.

Code and RAM are what the linker says (text + data, data + bss). Instructions are those that QEMU executed, one a block: of an
interrupt of the line that stored one octet, and of one whose octet ended a header; the least of many, because the host decides
in QEMU what else a handler finds to do. They are taken from FDL status requests to the image as delivered.

usage: budget.py [--table]
"""
import bisect
import functools
import os
import pty
import re
import select
import subprocess
import sys
import tempfile
import time
import tty

from machine import qemu
from station import expect, run_tests

IMAGES = {"com86": ("fieldling-dp", "fieldling-modbus"), "lm3s6965evb": ("fieldling-dp", "fieldling-modbus"),
          "bluepill": ("fieldling-dp", "fieldling-modbus")}
REQUESTS = {  # FDL status of the station as delivered; EN 50170-2 part 4, 4.7
    "com86": "10 7E 02 49 C9 16", "lm3s6965evb": "10 03 02 49 4E 16"}
HANDLER = {"com86": "irq3", "lm3s6965evb": "line_isr"}
TIMES = 8


def limits(board):
    """-> {name: limit}"""
    with open(f"boards/{board}/budget.txt", encoding="ascii") as file:
        lines = (line.split("#")[0].split() for line in file)
        return {words[0]: int(words[1]) for words in lines if words}


def tool(board, name):
    return name if board == "com86" else f"arm-none-eabi-{name}"


def size(board, image):
    out = subprocess.run([tool(board, "size"), "-A", f"build/{board}/{image}.elf"], text=True, check=True,
                         stdout=subprocess.PIPE).stdout
    sections = {words[0]: int(words[1]) for words in map(str.split, out.splitlines()) if len(words) == 3 and words[0][0] == "."}
    return {"code": sections[".text"] + sections[".data"], "ram": sections[".data"] + sections[".bss"]}


class Symbols:
    def __init__(self, board, image):
        out = subprocess.run([tool(board, "nm"), f"build/{board}/{image}.elf"], text=True, check=True,
                             stdout=subprocess.PIPE).stdout
        thumb = 0 if board == "com86" else 1
        self.at = sorted((int(a, 16) & ~thumb, name) for a, kind, name in map(str.split, out.splitlines()) if kind in "tT")
        self.starts = [a for a, _ in self.at]

    def __call__(self, pc):
        return self.at[bisect.bisect_right(self.starts, pc) - 1][1]


def traced(board, image, octets, folder):
    """Let the image hear octets, one in 1.5 ms (less than T_SYN at 9600 bit/s), and answer. -> (function, is its first) of each instruction"""
    path = f"build/{board}/{image}.{'bin' if board == 'com86' else 'elf'}"
    log = f"{folder}/{board}-{image}.log"
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    command = qemu(path, console="null,id=console", line=f"serial,id=line,path={os.ttyname(theirs)}", events=log,
                   more=["-singlestep", "-d", "exec,nochain"])
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        try:
            time.sleep(1.5)
            for _ in range(TIMES):
                for octet in octets:
                    os.write(ours, bytes([octet]))
                    time.sleep(0.0015)
                if select.select([ours], [], [], 0.2)[0]:
                    os.read(ours, 256)
        finally:
            process.terminate()
            process.wait()
    os.close(ours)
    os.close(theirs)
    symbol = Symbols(board, image)
    first = set(symbol.starts)
    with open(log, encoding="ascii", errors="replace") as file:
        for line in file:
            found = re.search(r"Trace 0: \S+ \[[0-9a-f]+/([0-9a-f]+)/", line)
            if found:
                yield symbol(int(found.group(1), 16)), int(found.group(1), 16) in first
    os.unlink(log)


def interrupts(board, image, octets, folder):
    """-> for each interrupt of the line that woke the sleeping main loop: (instructions, functions entered)"""
    n, entered, before = 0, [], ""
    for name, is_first in traced(board, image, octets, folder):
        if n == 0 and name == HANDLER[board] and is_first and before == "hal_idle":
            n, entered = 1, [name]
        elif n and name == "hal_idle":
            yield n, entered
            n = 0
        elif n:
            n += 1
            if is_first:
                entered.append(name)
        before = name


@functools.lru_cache(None)
def instructions(board):
    """-> {"octet_instructions": of an interrupt that only stores one, "chunk_instructions": of one that parses a header}"""
    with tempfile.TemporaryDirectory() as folder:
        seen = list(interrupts(board, "fieldling-dp", bytes.fromhex(REQUESTS[board]), folder))
    one = [(n, entered) for n, entered in seen if entered.count("line_octet_isr") == 1]
    store = [n for n, entered in one if "phy_chunk_ind_isr" not in entered and "hal_send" not in entered]
    chunk = [n for n, entered in one if "phy_chunk_ind_isr" in entered]
    expect(f"{board}: octets seen", len(store) >= TIMES and len(chunk) >= 1, True)
    return {"octet_instructions": min(store), "chunk_instructions": min(chunk),
            "end_instructions": max(chunk)}


def figures(board):
    found = {}
    for image in IMAGES[board]:
        short = image.split("-")[1]
        found.update({f"{short}_{what}": value for what, value in size(board, image).items()})
    if board in REQUESTS:
        found.update({name: n for name, n in instructions(board).items() if name != "end_instructions"})
    return found


def within_budget(board):
    most = limits(board)
    found = figures(board)
    expect("figures", sorted(found), sorted(most))
    for name, value in found.items():
        print(f"  {board:12} {name:20} {value:6} of {most[name]}")
    over = {name: value for name, value in found.items() if value > most[name]}
    expect("over the budget", over, {})


def test_com86_is_within_its_budget():
    within_budget("com86")


def test_lm3s6965evb_is_within_its_budget():
    within_budget("lm3s6965evb")


def test_bluepill_is_within_its_budget():
    within_budget("bluepill")


CYCLES_OF_ENTRY_AND_EXIT = 12 + 10  # ARM Cortex-M3 technical reference manual, 12.1
CYCLES_AN_INSTRUCTION = 1.5         # our choice: loads and taken branches cost two or three, the rest one


def table():
    """The highest PROFIBUS rate whose character (11 bits) is longer than the interrupt of an octet inside a telegram. The last
    octet may take longer: nothing follows it, and the answer has until max T_SDR."""
    found = instructions("lm3s6965evb")
    longest = found["chunk_instructions"] * CYCLES_AN_INSTRUCTION + CYCLES_OF_ENTRY_AND_EXIT
    print("Cortex-M3, -Os, PL011 without FIFO: " + ", ".join(f"{name} {value}" for name, value in found.items()))
    for mhz in (48, 100):
        us = longest / mhz
        best = max((rate for rate in (9600, 19200, 45450, 93750, 187500, 500000, 1500000, 3000000) if 11e6 / rate > us), default=0)
        print(f"  {mhz:3} MHz: {us:.1f} us an octet at {CYCLES_AN_INSTRUCTION} cycles an instruction: {best} bit/s")


if __name__ == "__main__":
    if sys.argv[1:] == ["--table"]:
        table()
    else:
        sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
