#!/usr/bin/env python3
"""DP-TEST01 on the 87C51FB, in the simulator s51, under masters on a pseudo terminal: pyprofibus, which nobody here
wrote, and sim's fieldling-master; at 9.6, 19.2 and 93.75 kbit/s, and with octets that come with wrong parity.

Simulation and master run in the host's time, so every wait is long, and requests are repeated as a master repeats them.
The process inputs of the simulated board read back its outputs: what the master sends must come back as its inputs.
"""
import json
import subprocess
import sys
import tempfile
from collections import namedtuple
from pathlib import Path

from pyprofibus.dp_master import DpMaster, DpSlaveState

from interop_pyprofibus import Master, handle_short_ack, number
from station import expect, run_tests

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from chip_pty import ChipOnPty  # noqa: E402

Line = namedtuple("Line", "rate mhz n image")  # n: Timer 2's divisor
AT_9600 = Line(9600, 12, 39, "fieldling-dp")
AT_19200 = Line(19200, 24, 39, "fieldling-dp-24mhz")
AT_93750 = Line(93750, 12, 4, "fieldling-dp")

ADDRESS = 5      # the switches
EXCHANGES = 25 
SECONDS = 60.0   # for one exchange, bring-up included
OLD_INPUTS = 3   # so many answers may still carry inputs from before the outputs
SLOT_MS = 1000   # of fieldling-master; its retries are as many as it takes
SETUP = f"slave {ADDRESS}\n gsd {ROOT}/gsd/FLDL1234.GSD\n watchdog 60000\n"  # [ms]: longer than some slots
SPOILT = 89      # one in so many octets has wrong parity


def wait_longer(times=20):
    """This master waits 10 to 100 ms, from the request's first octet on, and half a second in a state: too short at
    9.6 kbit/s, where a request takes 13 ms by itself, on a busy machine."""
    send = DpMaster._DpMaster__send

    def send_and_wait(master, slave, telegram, timeout):
        return send(master, slave, telegram, timeout * times)

    DpMaster._DpMaster__send = send_and_wait
    for state, seconds in DpSlaveState.stateTimeLimits.items():
        if seconds > 0:
            DpSlaveState.stateTimeLimits[state] = seconds * times


def exchange_all(master, n):
    """n different outputs, each until it is the inputs."""
    for i in range(1, n + 1):
        outputs = number(i * 0x1357 & 0xFFFF)
        for _ in range(OLD_INPUTS):
            inputs = master.exchange(outputs, SECONDS)
            if inputs == outputs:
                break
        expect(f"inputs of exchange {i}", inputs, outputs)


def on_chip(line, talk, prepare=lambda chip: None):
    """talk(pty) with the chip at its end. -> the chip, when it has ended"""
    with ChipOnPty(str(ROOT / f"build/87c51fb/{line.image}.ihx"), line.n, mhz=line.mhz, switches=ADDRESS) as chip:
        prepare(chip)
        chip.start()
        talk(chip.pty)
    chip.read_log()
    requests = chip.requests()
    print(f"    {line.rate} bit/s: {len(requests)} telegrams to the chip, {sum(t.answered > 0 for t in requests)} answers "
          f"in {(chip.log[-1][2] - chip.log[0][2]) * 12 / line.mhz / 1e6:.1f} s of simulated time")
    return chip


# ---- pyprofibus ----

def pyprofibus(line):
    def talk(pty):
        with Master(pty, watchdog_ms=0, address=ADDRESS, rate=line.rate) as master:
            exchange_all(master, EXCHANGES)
            expect("connected", master.slave.isConnected(), True)
    return talk


def even_parity_was_sent(chip):
    octets, parity = chip.octets_sent, chip.parity_sent()
    if len(octets) < 11 * EXCHANGES:  # Data_Exchange is answered by 11 octets
        raise AssertionError(f"only {len(octets)} octets sent")
    # the last answer may not have left the simulator
    expect("parity", parity[:len(octets)], [bin(octet).count("1") & 1 for octet in octets])


def test_pyprofibus_at_9600_data_go_both_ways_and_every_octet_sent_has_even_parity():
    even_parity_was_sent(on_chip(AT_9600, pyprofibus(AT_9600)))


def test_pyprofibus_at_19200_with_24_MHz():
    even_parity_was_sent(on_chip(AT_19200, pyprofibus(AT_19200)))


def test_pyprofibus_at_93750():
    even_parity_was_sent(on_chip(AT_93750, pyprofibus(AT_93750)))


def test_pyprofibus_a_telegram_with_wrong_parity_is_dropped_and_the_next_ones_are_answered():
    # the third octet of the first telegram, FDL status
    requests = on_chip(AT_9600, pyprofibus(AT_9600), lambda chip: chip.spoil(3)).requests()
    expect("octets of the first telegram", requests[0].octets, 6)
    expect("octets of the answer to the spoilt telegram", requests[0].answered, 0)
    expect("octets of the answer to its repetition", requests[1].answered, 6)


# ---- sim's master ----

def fieldling_master(line, said):
    def talk(pty):
        with tempfile.NamedTemporaryFile("w", suffix=".dp") as setup:
            setup.write(SETUP)
            setup.flush()
            result = subprocess.run(
                [str(ROOT / "build/posix/fieldling-master"), "--line", pty, "--rate", str(line.rate), "--slot", str(SLOT_MS),
                 "--retries", "15", "--count", "--cycles", str(EXCHANGES), "--json", "cyclic", setup.name],
                stdin=subprocess.DEVNULL, capture_output=True, timeout=200, check=False)
        expect("exit status of fieldling-master", (result.returncode, result.stderr.decode()), (0, ""))
        for text in result.stdout.decode().splitlines():
            said.update(json.loads(text))
    return talk


def exchanged(line, prepare=lambda chip: None):
    """-> the chip, and what the master said at its end."""
    said = {}
    chip = on_chip(line, fieldling_master(line, said), prepare)
    expect("state", said["state"], "exchange")
    for what, number_of in {"starts": 1, "lost": 0, "refused": 0, "wrong": 0}.items():
        expect(what, said[what], number_of)
    if said["exchanges"] < EXCHANGES - 15:  # so many cycles may bring-up take
        raise AssertionError(f"only {said['exchanges']} exchanges")
    # --count: each output goes up by one now and then; the last exchange may have brought the inputs from before that
    behind = [o - i for i, o in zip(bytes.fromhex(said["inputs"]), bytes.fromhex(said["outputs"]))]
    if behind not in ([0, 0], [1, 1]) or said["inputs"] == "00 00":
        raise AssertionError(f"inputs {said['inputs']} behind outputs {said['outputs']}")
    print(f"    {said['exchanges']} exchanges, {said['retries']} retries")
    return chip, said


def test_fieldling_master_at_9600():
    exchanged(AT_9600)


def test_fieldling_master_at_19200_with_24_MHz():
    exchanged(AT_19200)


def test_fieldling_master_at_93750():
    exchanged(AT_93750)


def test_octets_with_wrong_parity_are_counted_and_the_exchange_goes_on():
    def prepare(chip):
        chip.note("parity")
        chip.spoil_every(SPOILT)

    chip, said = exchanged(AT_9600, prepare)
    counts = chip.noted_counts()
    if len(counts) < 3:
        raise AssertionError(f"only {len(counts)} octets with wrong parity")
    expect("counted", counts, list(range(1, len(counts) + 1)))
    expect("the master repeated what was dropped", said["retries"] > 0, True)  # but for Global_Control


if __name__ == "__main__":
    handle_short_ack()
    wait_longer()
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
