#!/usr/bin/env python3
"""The cases of dp_cases.py on the host station, in real time on a pseudo terminal: the same table as on the 8051
(s51_states.py), so that both are held to the same octets. Cases that need bit times, milliseconds or parity are not
played: their twins are in test_dp_*.c, in virtual time.
"""
import os
import sys
import tempfile

import dp_cases
from raw_master import RawMaster
from station import Station, expect

ADDRESS, INPUTS = 8, "1E 00"
QUIET = 0.03  # seconds without an answer are silence
SLOT = 2.0    # seconds for an answer; not repeated: nothing is lost here
RATE = "500000"


class Bench:
    """Plays the steps of a case on fieldling-dp."""

    def __init__(self, folder):
        self.nv, self.given, self.station, self.master = os.path.join(folder, "nv"), INPUTS, None, None
        self.power(ADDRESS)

    def off(self):
        self.master.__exit__()
        self.station.__exit__()

    def power(self, switches):
        if self.station:
            self.off()
        self.station = Station("fieldling-dp", "--address", str(switches), "--baud", RATE, "--nv", self.nv)
        self.station.__enter__()
        self.master = RawMaster(self.station.pty)
        self.inputs(self.given)

    def new_battery(self):
        if os.path.exists(self.nv):
            os.remove(self.nv)

    def inputs(self, text):
        self.given = text
        for module, value in zip((1, 3), bytes.fromhex(text)):
            self.station.ask(f"in {module} {value}")
        self.turn()

    def turn(self):
        """Of the main loop, and one more: what has come is done."""
        for _ in range(2):
            self.station.ask("status")

    def ask(self, request, expected):
        self.master.say(request)
        answer = self.master.hear(SLOT if expected else QUIET, len(bytes.fromhex(expected)) or 1)
        expect(request, answer.hex(" ").upper(), expected)
        self.turn()

    def out(self, octets):
        expect("outputs", self.station.ask("out")["out"], octets.replace(" ", ""))


def main(words):
    cases = [(name, steps) for name, steps in dp_cases.CASES
             if not dp_cases.needs_own_time(steps) and all(word in name for word in words)]
    failed = 0
    for name, steps in cases:
        with tempfile.TemporaryDirectory(prefix="fieldling-") as folder:
            bench, wrong = Bench(folder), ""
            try:
                for verb, *arguments in steps:
                    getattr(bench, verb)(*arguments)
            except Exception as error:  # whatever it is, it is this case's failure
                failed += 1
                wrong = f"{type(error).__name__}: {error}"
            bench.off()
        print(f"{__file__}:0:{name}:" + (f"FAIL: {wrong}" if wrong else "PASS"), flush=True)
    print(f"\n{len(cases)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
