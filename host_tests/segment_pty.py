#!/usr/bin/env python3
"""Several stations on one segment over pseudo terminals (fieldling-segment), a master written out in octets."""
import os
import shutil
import subprocess
import sys
import tempfile
import time

from raw_master import RawMaster
from station import PATIENCE, expect, run_tests

BIN = os.environ.get("FIELDLING_BIN", "build/posix")

# FDL status of master 2; SD1, sums of DA SA FC: EN 50170-2 part 4, 4.7
STATUS_8 = "10 08 02 49 53 16", "10 02 08 00 0A 16"
STATUS_9 = "10 09 02 49 54 16", "10 02 09 00 0B 16"


class Segment:
    """A segment with n ports, named 0.. in a fresh folder, and the processes on it."""

    def __init__(self, n, *options):
        self.folder = tempfile.mkdtemp(prefix="fieldling-")
        self.ports = [os.path.join(self.folder, str(i)) for i in range(n)]
        self.processes = []
        self.process = self.start("fieldling-segment", *options, *self.ports)
        expect("says", self.process.stdout.readline(), f"segment of {n}\n")

    def start(self, program, *arguments):
        process = subprocess.Popen([os.path.join(BIN, program), *arguments], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, text=True)
        self.processes.append(process)
        return process

    def station(self, port, address):
        return self.start("fieldling-dp", "--line", self.ports[port], "--address", str(address), "--baud", "19200")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
            process.communicate(timeout=PATIENCE)
        shutil.rmtree(self.folder, ignore_errors=True)


def test_what_one_says_all_others_hear_and_it_does_not():
    with Segment(3) as segment:
        parties = [RawMaster(port) for port in segment.ports]
        time.sleep(0.1)  # the segment looks at unused ports every 20 ms
        parties[1].say("68 05 00 FF E5")
        expect("0 hears", parties[0].hear(n=5), bytes.fromhex("68 05 00 FF E5"))
        expect("2 hears", parties[2].hear(n=5), bytes.fromhex("68 05 00 FF E5"))
        expect("1 hears", parties[1].hear(0.1), b"")


def test_two_stations_answer_each_to_its_address():
    with Segment(3) as segment:
        segment.station(1, 8)
        segment.station(2, 9)
        with RawMaster(segment.ports[0]) as master:
            for _ in range(50):
                master.ask(*STATUS_8)
                master.ask(*STATUS_9)
            master.no_answer("10 0A 02 49 55 16")


def test_what_was_said_while_nobody_was_there_is_gone():
    with Segment(2) as segment:
        with RawMaster(segment.ports[0]) as alone:
            time.sleep(0.1)
            alone.say("01 02 03")
            time.sleep(0.1)
            with RawMaster(segment.ports[1]) as late:
                time.sleep(0.1)
                alone.say("04")
                expect("hears", late.hear(), b"\x04")


def test_a_master_that_retries_gets_through_every_fault():
    for fault in ("ONE_BIT", "TWO_BITS", "LOST_OCTET", "DOUBLED_OCTET", "TRUNCATED", "NOISE_BEFORE", "LOST_REQUEST",
                  "LOST_ANSWER", "FOREIGN"):
        with Segment(2, "--fault", fault + ":4", "--seed", "5") as segment:
            segment.station(1, 8)
            with RawMaster(segment.ports[0]) as master:
                for _ in range(10):
                    for _ in range(20):
                        master.say(STATUS_8[0])
                        if bytes.fromhex(STATUS_8[1]) in master.hear(0.05, n=6):
                            break
                    else:
                        raise AssertionError(f"{fault}: no good answer in 20 tries")


def test_its_links_go_when_it_ends():
    with Segment(2) as segment:
        segment.process.terminate()
        expect("exit status", segment.process.wait(PATIENCE), 0)
        expect("links", [p for p in segment.ports if os.path.lexists(p)], [])


def test_unusable_arguments_are_refused():
    nowhere = os.path.join(os.path.dirname(os.path.abspath(__file__)), "no such folder", "line")
    for arguments in ([], ["only-one"], ["--fault", "NONSENSE", "a", "b"], [nowhere, nowhere + "2"]):
        done = subprocess.run([os.path.join(BIN, "fieldling-segment"), *arguments], capture_output=True, text=True,
                              timeout=PATIENCE, check=False)
        expect(f"exit status with {arguments}", done.returncode, 2)
        expect("says why", done.stderr != "", True)


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
