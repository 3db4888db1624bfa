#!/usr/bin/env python3
"""The contract of hal.h on the 87C51FB in the simulator s51: hal_contract.c in the product's own memory model.

The peer on the line sends back what the chip has sent, 35 ms later, in simulated time. Unity is too large for the part's
internal RAM in this model: contract/s51/unity.h has its words, and what it writes down is read here.
usage: s51_contract.py [IMAGE]
"""
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
import chip as s51  # noqa: E402

ECHO_CYCLES = 35000
STEPS = 4000  # instructions at a time


def tests():
    """Names in the order hal_contract.c runs them."""
    return re.findall(r"RUN_TEST\((\w+)\)", (ROOT / "host_tests" / "hal_contract.c").read_text())


def reason(line):
    """What the TEST_IGNORE_MESSAGE of this line says."""
    return (ROOT / "host_tests" / "hal_contract.c").read_text().splitlines()[line - 1].split('"')[1]


def xdata(image, name):
    text = Path(image.replace(".ihx", ".map")).read_text()
    return int(re.search(rf"^\s*(?:D:)?\s+([0-9A-F]{{8}})\s+_{name}\b", text, re.M)[1], 16)


def words(chip, address, n):
    """n numbers of 16 bits at address of external RAM."""
    text = chip.command(f"dump xram 0x{address:x} 0x{address + 2 * n - 1:x}")
    octets = [int(o, 16) for row in re.findall(r"^0x[0-9a-f]+ .*?((?:\b[0-9a-f]{2} )+)", text, re.M) for o in row.split()]
    return [low | high << 8 for low, high in zip(octets[0::2], octets[1::2])]


def echo(chip):
    """The chip has just ended a transmission."""
    end = chip.cycles + ECHO_CYCLES
    while chip.cycles < end:
        chip.step(STEPS)
    os.write(chip.input, os.read(chip.output, 4096))


def run(chip):
    chip.break_at(f"0x{chip.symbols['unity_done']:x}")
    chip.break_at(f"0x{chip.symbols['line_sent_isr']:x}")
    while f"Stop at 0x{chip.symbols['unity_done']:06x}" not in chip.command("run"):
        echo(chip)


def main(image=str(ROOT / "build" / "s51_contract" / "hal_contract.ihx")):
    names, failures, ignored = tests(), 0, 0
    with s51.Chip(image) as chip:
        run(chip)
        results = words(chip, xdata(image, "unity_results"), 4 * len(names))
    for i, name in enumerate(names):
        failure, expected, was, ignore = results[4 * i:4 * i + 4]
        failures += failure != 0
        ignored += ignore != 0
        print(f"host_tests/hal_contract.c:{failure or ignore}:{name}:" +
              (f"FAIL: expected {expected}, was {was}" if failure else f"IGNORE: {reason(ignore)}" if ignore else "PASS"))
    print(f"\n{len(names)} Tests {failures} Failures {ignored} Ignored")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
