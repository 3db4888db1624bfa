#!/usr/bin/env python3
"""124 stations on one segment in virtual time: all come up, each exchanges its own data, nobody breaks a rule of the line."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import scripted

BIN = Path(os.environ.get("FIELDLING_BIN", "build/posix"))
# Each copy of the station has the same globals under the same names, on purpose.
ENVIRONMENT = dict(os.environ, ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":detect_odr_violation=0:detect_leaks=0")
RATE_93K75, RATE_500K, RATE_12M = 2, 4, 10  # spec A1; 10: firmware/phy_uart/phy_uart.h


def many(*arguments):
    return subprocess.run([str(BIN / "fieldling-many"), str(BIN / "fieldling-station.so"), *map(str, arguments)],
                          capture_output=True, timeout=110, env=ENVIRONMENT)


def bus(stations, cycles, rate):
    result = many(stations, cycles, rate)
    output = result.stdout.decode()
    assert result.returncode == 0, f"exit {result.returncode}: {output}{result.stderr.decode()[:2000]}"
    words = output.split()
    return dict(zip(words[::2], map(float, words[1::2])))


def good(said, stations, exchanges):
    assert said["stations"] == said["in_exchange"] == said["exact"] == stations, said
    assert said["fewest_exchanges"] == exchanges, said
    assert said["retries"] == said["collisions"] == said["early"] == said["late"] == 0, said


def test_124_stations_come_up_and_exchange_their_own_data():
    # FDL status, diagnosis, parameters, configuration, diagnosis: five cycles, then data
    good(bus(124, 20, RATE_500K), 124, 15)


def test_at_a_slow_and_at_the_fastest_rate():
    good(bus(124, 8, RATE_93K75), 124, 3)
    good(bus(124, 20, RATE_12M), 124, 15)


def test_the_bus_cycle_is_what_the_octets_take():
    """A request and its answer of 11 octets each: 2 * 121 T_bit, T_SDR 11 and T_SYN 33: 286 T_bit, 572 us at 500 kbit/s. The
    cycle is that for each station, exactly."""
    assert bus(1, 20, RATE_500K)["cycle_ms"] == 0.572
    assert bus(8, 20, RATE_500K)["cycle_ms"] == 4.576
    assert bus(124, 20, RATE_500K)["cycle_ms"] == 70.928


def test_two_stations_with_one_address_are_noticed():
    result = many("twins")
    assert result.returncode == 1 and int(re.search(r"collisions (\d+)", result.stdout.decode()).group(1)) > 5, result


def test_the_analyzer_agrees():
    """The record of four stations, each telegram with its exact times: T_SDR 11 T_bit, T_SYN before each request."""
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "many.rec"
        assert many(4, 12, RATE_500K, record).returncode == 0
        result = subprocess.run([str(BIN / "fieldling-mon"), "-q", "--summary", str(record)], capture_output=True, timeout=30)
        lines = result.stdout.decode().splitlines()
        assert result.returncode == 0 and "0 requests without T_SYN; 0 wrong" in lines[0], lines
        for address, line in zip(range(1, 5), lines[2:]):
            # 12 questions each, two acknowledged; 7 exchanges: 6 cycles of 4 * 572 us
            assert line.split() == [str(address), "12", "12", "2", "0", "0", "0", "11.00/", "11.00/", "11.00", "2.29/",
                                    "2.29/", "2.29"], line


def test_the_readmes_picture_is_what_is_drawn():
    with tempfile.TemporaryDirectory() as folder:
        record, picture = Path(folder) / "six.rec", Path(folder) / "six.svg"
        assert many(6, 30, RATE_500K, record).returncode == 0
        subprocess.run([str(BIN / "fieldling-mon"), "-q", "--plot", str(picture), str(record)], check=True, timeout=30)
        assert picture.read_text() == Path("sim/bus_cycle.svg").read_text(), "sim/bus_cycle.svg is old (sim/README.md)"


def test_wrong_usage():
    for arguments in ((), (0,), (125,), (5, 0), (5, 5, 11)):
        assert many(*arguments).returncode == 2, arguments
    assert subprocess.run([str(BIN / "fieldling-many"), "no/such.so", "2"], capture_output=True).returncode == 2


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), __file__))
