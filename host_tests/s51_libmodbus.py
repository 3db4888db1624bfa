#!/usr/bin/env python3
"""The Modbus inverter on the 87C51FB, in the simulator s51, under clients nobody here wrote: libmodbus and mbpoll.

Simulation and clients run in the host's time: every wait is long, and what is not answered is asked again, a bounded number
of times.
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

from libmodbus import OUTPUT_FREQ, RUN, SET_POINT, TRIES, Libmodbus
from station import Skip, expect, run_tests

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from chip_modbus import ModbusChipOnPty  # noqa: E402

IMAGE = "build/87c51fb/fieldling-modbus.ihx"
N_9600 = 39
SECONDS = 5  # a client waits for an answer


def run(spoilt=None):
    """Registers and coils, written and read back. -> the chip, when it has ended"""
    with ModbusChipOnPty(IMAGE, N_9600) as chip:
        if spoilt:
            chip.spoil(spoilt)
        chip.start()
        with Libmodbus(chip.pty, SECONDS) as client:
            expect("defaults", client.holding(SET_POINT, 3), [5000, 0, 6000])
            for n in range(20):
                client.write(SET_POINT, 100 + n, 0)
                expect("set point", client.holding(SET_POINT), [100 + n])
            client.coil(RUN, 1)
            client.coil(RUN, 0)
            expect("input register", len(client.inputs(OUTPUT_FREQ)), 1)
    chip.read_log()
    return chip


def test_libmodbus_reads_and_writes_and_every_octet_sent_has_even_parity():
    chip = run()
    sent, parity = chip.octets_sent, chip.parity_sent()
    expect("octets sent", len(sent) > 40 * 8, True)
    expect("parity", parity[:len(sent)], [bin(octet).count("1") & 1 for octet in sent])


def test_a_request_with_wrong_parity_is_dropped_and_its_repetition_answered():
    requests = run(spoilt=3).requests()
    expect("octets of the first request", requests[0].octets, 8)
    expect("answered", (requests[0].answered, requests[1].answered), (0, 11))


def mbpoll(pty, count=None, value=None):
    if not shutil.which("mbpoll"):
        raise Skip("mbpoll is not installed")
    for _ in range(TRIES):
        done = subprocess.run(["mbpoll", "-m", "rtu", "-a", "1", "-b", "9600", "-P", "even", "-0", "-1", "-q", "-o", str(SECONDS),
                               "-t", "4", "-r", "0", *(["-c", count] if count else []), pty, *([value] if value else [])], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=30, check=False)
        if done.returncode == 0:
            return done.stdout
    raise AssertionError(done.stdout)


def test_mbpoll_writes_and_reads():
    with ModbusChipOnPty(IMAGE, N_9600) as chip:
        chip.start()
        expect("written", "Written 1 reference" in mbpoll(chip.pty, value="1234"), True)
        said = mbpoll(chip.pty, count="3")
        expect(said, re.findall(r"\[\d+\]:\s*(\d+)", said), ["1234", "0", "6000"])


def test_make_run_shows_the_drive_run_up_and_down():
    done = subprocess.run([sys.executable, "host_tests/run_board.py", "87c51fb", "60", "modbus"], text=True, timeout=120,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    shown = [float(f) for f in re.findall(r"output +([0-9.]+) Hz", done.stdout)]
    expect(done.stdout, (done.returncode, max(shown), shown[-1]), (0, 30.0, 0.0))


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
