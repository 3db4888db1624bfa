#!/usr/bin/env python3
"""What the images of the gcc boards take, beside boards/BOARD/budget.txt: a figure above its limit is a failure.

Code and RAM are what the linker says (text + data, data + bss). Instructions are counted by QEMU with -icount, which makes
them the machine's clock, and octets are fed to it while it stands still (counted.py): the same image gives the same figures
wherever and whenever it runs. They are those of an interrupt of the line that stored one octet, and of one whose octet ended a
part of a header, while FDL status requests come to the image as delivered; the most of each. Of a telegram they are all that
ran, the main loop's pass after each octet too, from the interrupt of its first octet to hal_send() of the answer.

The stack is what lost the paint of the start-up code while a master and the console kept the station busy for some seconds. It
is a high-water mark of that run, not a bound: that no interrupt came at the deepest place is luck, hence room in the limits.

usage: budget.py [--table]
"""
import functools
import subprocess
import sys
import tempfile
import time

from counted import Counted, Monitor, output_of, tool
from machine import Machine, image_path
from raw_master import RawMaster
from run_board import ADDRESS, DELIVERED, MASTER, RATE, set_address
from station import expect, run_tests

IMAGES = {"com86": ("fieldling-dp", "fieldling-modbus"), "lm3s6965evb": ("fieldling-dp", "fieldling-modbus"),
          "bluepill": ("fieldling-dp", "fieldling-modbus"), "rv32virt": ("fieldling-dp", "fieldling-modbus")}
REQUESTS = {  # FDL status of the station as delivered; EN 50170-2 part 4, 4.7
    "com86": "10 7E 02 49 C9 16", "lm3s6965evb": "10 03 02 49 4E 16"}
HANDLER = {"com86": "irq3", "lm3s6965evb": "line_isr"}
TIMES = 4
STARTED, BETWEEN = 10, 15  # times that the main loop goes to sleep first, and between two requests
READ_3_REGISTERS = "01 03 00 00 00 03 05 CB"  # Modbus application protocol 6.3
MODBUS_REQUESTS = [  # what a master asks in turn: coils, registers, one written, four written, diagnostics, a wrong function
    "01 01 00 00 00 01 FD CA", READ_3_REGISTERS, "01 06 00 00 04 D2 0B 57", "01 10 00 00 00 01 02 03 E8 A6 EE",
    "01 08 00 00 A5 37 DA 8D", "01 41 C0 10"]
PAINT = 0xA5
BUSY_S = 4


def limits(board):
    """-> {name: limit}"""
    with open(f"boards/{board}/budget.txt", encoding="ascii") as file:
        lines = (line.split("#")[0].split() for line in file)
        return {words[0]: int(words[1]) for words in lines if words}


def size(board, image):
    out = output_of(tool(board, "size"), "-A", f"build/{board}/{image}.elf")
    sections = {words[0]: int(words[1]) for words in map(str.split, out.splitlines()) if len(words) == 3 and words[0][0] == "."}
    return {"code": sections[".text"] + sections[".data"], "ram": sections[".data"] + sections[".bss"]}


@functools.lru_cache(None)
def listed(board, image, request):
    """The image hears request once, to find its rate, then TIMES times. -> [(function, is this its first instruction) of each
    instruction that ran then]"""
    with Counted(board, image) as machine:
        machine.sleep(STARTED)
        for turn in range(1 + TIMES):
            machine.listing(turn > 0)
            machine.hear(bytes.fromhex(request))
            machine.sleep(BETWEEN)
        machine.listing(False)
        return list(machine.trace())


def interrupts(board, image, request):
    """-> for each interrupt of the line that woke the sleeping main loop: (instructions, functions entered)"""
    n, entered, before = 0, [], ""
    for name, is_first in listed(board, image, request):
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


def telegrams(board, image, request):
    """-> for each answered request: the instructions from its first octet to hal_send(), those of going to sleep excepted"""
    n, heard = 0, False
    for name, is_first in listed(board, image, request):
        if is_first and name == HANDLER[board] and not heard:
            n = 0
        n += name != "hal_idle"
        if is_first and name == "line_octet_isr":
            heard = True
        elif is_first and name == "hal_send" and heard:
            yield n
            heard = False


def telegram_instructions(board, image, request):
    seen = list(telegrams(board, image, request))
    expect(f"{board} {image}: answers seen", len(seen), TIMES)
    return max(seen)


def address_of(board, image, *names):
    out = output_of(tool(board, "nm"), f"build/{board}/{image}.elf")
    at = {name: int(a, 16) for a, _, name in map(str.split, out.splitlines())}
    return [at[name] for name in names]


def kept_busy_with_dp(board, machine):
    station = DELIVERED[board]
    if station == 126:
        set_address(machine, station)
        station = ADDRESS
    command = [MASTER, "--line", machine.pty, "--rate", RATE, "--retries", "5", "--slot", "100",
               "--slave", f"{station}=gsd/FLDL1234.GSD", "--count", "--seconds", str(BUSY_S), "cyclic"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while process.poll() is None:
            machine.ask("in 1 77")
            said = machine.ask("status")
    expect("data were exchanged", int(said["data_exchange"]) > 50, True)


def kept_busy_with_modbus(_, machine):
    answered, end = 0, time.monotonic() + BUSY_S
    with RawMaster(machine.pty) as asking:
        while time.monotonic() < end:
            for request in MODBUS_REQUESTS:
                asking.say(request)
                answered += bool(asking.hear(0.2))
                asking.hear(0.02)
            machine.ask("status")
    expect("requests were answered", answered > 50, True)


def stack(board, image):
    """-> octets of the stack that have been used"""
    bottom, top = address_of(board, image, "stack_bottom", "stack_top")
    with tempfile.TemporaryDirectory() as folder:
        with Machine(board, image, more=["-qmp", f"unix:{folder}/qmp,server=on,wait=off"]) as machine:
            (kept_busy_with_dp if image == "fieldling-dp" else kept_busy_with_modbus)(board, machine)
            with Monitor(f"{folder}/qmp") as monitor:
                octets = monitor.memory(bottom, top, f"{folder}/stack")
    unused = len(octets) - len(octets.lstrip(bytes([PAINT])))
    expect(f"{board} {image}: paint is left", unused > 0, True)
    return len(octets) - unused


@functools.lru_cache(None)
def instructions(board):
    """-> {"octet_instructions": of an interrupt that only stores one, "chunk_instructions": of one that looks at SD and DA}"""
    seen = list(interrupts(board, "fieldling-dp", REQUESTS[board]))
    one = [(n, entered) for n, entered in seen if entered.count("line_octet_isr") == 1]
    alone = [(n, entered) for n, entered in one if "line_uart_timer_isr" not in entered]  # nor a timer right behind it
    store = [n for n, entered in alone if "phy_chunk_ind_isr" not in entered and "hal_send" not in entered]
    chunk = [n for n, entered in one if "phy_chunk_ind_isr" in entered and "fdl_telegram_isr" not in entered]
    end = [n for n, entered in one if "fdl_telegram_isr" in entered]
    expect(f"{board}: octets seen", (len(one) - len(chunk) - len(end), len(chunk), len(end)), (4 * TIMES, TIMES, TIMES))
    expect(f"{board}: octets alone", len(store) > TIMES, True)
    return {"octet_instructions": max(store), "chunk_instructions": max(chunk), "end_instructions": max(end)}


def figures(board):
    found = {}
    for image in IMAGES[board]:
        short = image.split("-")[1]
        found.update({f"{short}_{what}": value for what, value in size(board, image).items()})
    if board in REQUESTS:
        found.update({name: n for name, n in instructions(board).items() if name != "end_instructions"})
        found["dp_telegram_instructions"] = telegram_instructions(board, "fieldling-dp", REQUESTS[board])
        found["modbus_telegram_instructions"] = telegram_instructions(board, "fieldling-modbus", READ_3_REGISTERS)
    if board in DELIVERED:
        found["dp_stack"] = stack(board, "fieldling-dp")
        found["modbus_stack"] = stack(board, "fieldling-modbus")
    return found


def within_budget(board):
    most = limits(board)
    found = figures(board)
    expect("figures", sorted(found), sorted(most))
    for name, value in found.items():
        print(f"  {board:12} {name:28} {value:6} of {most[name]}")
    over = {name: value for name, value in found.items() if value > most[name]}
    expect("over the budget", over, {})


def test_com86_is_within_its_budget():
    within_budget("com86")


def test_lm3s6965evb_is_within_its_budget():
    within_budget("lm3s6965evb")


def test_bluepill_is_within_its_budget():
    within_budget("bluepill")


def test_rv32virt_is_within_its_budget():
    image_path("rv32virt", "fieldling-dp")  # or skipped
    within_budget("rv32virt")


def test_the_same_image_gives_the_same_instructions_each_time():
    for board, request in REQUESTS.items():
        again = listed.__wrapped__(board, "fieldling-dp", request)
        expect(f"{board}: each one of them", listed(board, "fieldling-dp", request) == again and len(again) > 1000, True)


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
