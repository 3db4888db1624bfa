#!/usr/bin/env python3
"""profirust 0.6.0, another DP master nobody here wrote, drives fieldling-dp over a pseudo terminal.

The master (host_tests/interop_profirust) runs as a process of its own and sends numbers, each until it is answered.
The station's trace shows every telegram: retries taken out, the numbers must be there one after the other, and the
station's count of executed exchanges must be theirs.
"""
import os
import re
import subprocess
import sys

from station import Skip, Station, expect, run_tests

PEER = "build/interop_profirust"
EXCHANGES = 1000
ADDRESS = 8


def drive(station, exchanges):
    """-> lines of the master: number and inputs of each finished exchange"""
    if os.path.exists(f"{PEER}/skipped"):
        raise Skip(open(f"{PEER}/skipped").read().strip())
    done = subprocess.run([f"{PEER}/release/interop_profirust", station.pty, str(ADDRESS), str(exchanges)],
                          capture_output=True, text=True, timeout=90)
    expect("status of the master, which said " + done.stderr.replace("\n", " "), done.returncode, 0)
    events = done.stderr.split()
    expect("events at the master", events, ["Online", "Configured"])
    return done.stdout.split("\n")[:-1]


def test_thousand_exchanges_none_lost_none_doubled():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station:
        station.ask("trace on")
        station.ask("in 1 77")
        station.ask("in 3 200")
        exchanges = drive(station, EXCHANGES)
        expect("exchanges at the master", [line.split()[0] for line in exchanges],
               [str(n) for n in range(1, EXCHANGES + 1)])
        expect("inputs at the master", {line.split(" ", 1)[1] for line in exchanges}, {"4d c8"})

        station.wait(lambda: int(station.ask("out")["out"], 16) == EXCHANGES, "the last output")
        status = station.ask("status")
        # 68 05 05 68 DA SA FC data data FCS 16; a retry is the same telegram again
        telegrams = [match.group(1) for match in
                     (re.search(r"^trace=rx .*phy=(6805056808..[57]D....)", line) for line in station.traces) if match]
        new = [t for i, t in enumerate(telegrams) if i == 0 or t != telegrams[i - 1]]
        expect("numbers on the wire", [int(t[-4:], 16) for t in new], list(range(1, EXCHANGES + 1)))
        expect("exchanges executed", int(status["data_exchange"]), EXCHANGES)
        expect("traces lost", [line for line in station.traces if line.startswith("trace=lost")], [])
        for fault in ("parity", "format", "checksum", "wrong_length", "wd_expired", "refused"):
            expect(fault, status[fault], "0")


def test_next_master_gets_the_new_inputs():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station:
        station.ask("in 1 1")
        drive(station, 10)
        station.wait(lambda: station.ask("status")["state"] == "WAIT_PRM", "the watchdog, 2 s")
        station.ask("in 1 2")
        expect("inputs after the change", {line.split()[1] for line in drive(station, 10)}, {"02"})


if __name__ == "__main__":
    sys.exit(run_tests([test_thousand_exchanges_none_lost_none_doubled,
                        test_next_master_gets_the_new_inputs]))
