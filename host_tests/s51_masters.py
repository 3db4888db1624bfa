#!/usr/bin/env python3
"""DP-TEST01 on the 87C51FB, in the simulator s51, under a master nobody here wrote: pyprofibus, at 9.6 kbit/s.

The process inputs of the simulated board read back its outputs: what the master sends must come back as its inputs.
Simulation and master run in the host's time, so every wait is long, and requests are repeated as a master repeats them.
"""
import sys
from pathlib import Path

from pyprofibus.dp_master import DpMaster, DpSlaveState

from interop_pyprofibus import Master, handle_short_ack, number
from station import expect, run_tests

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from chip_pty import ChipOnPty  # noqa: E402

IMAGE = str(ROOT / "build" / "87c51fb" / "fieldling-dp.ihx")
N_9600 = 39      # Timer 2's divisor at 12 MHz
ADDRESS = 5      # the switches
EXCHANGES = 40
SECONDS = 60.0   # for one exchange, bring-up included
OLD_INPUTS = 3   # so many answers may still carry inputs from before the outputs


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


def run(spoilt=None):
    """Bring-up and EXCHANGES exchanges; the spoilt-th octet to the chip has wrong parity. -> the chip, when it has ended"""
    with ChipOnPty(IMAGE, N_9600, switches=ADDRESS) as chip:
        if spoilt:
            chip.spoil(spoilt)
        chip.start()
        with Master(chip.pty, watchdog_ms=0, address=ADDRESS, rate=9600) as master:
            exchange_all(master, EXCHANGES)
            expect("connected", master.slave.isConnected(), True)
    chip.read_log()
    requests = chip.requests()
    print(f"    {len(requests)} telegrams to the chip, {sum(t.answered > 0 for t in requests)} answers; bring-up and "
          f"{EXCHANGES} exchanges in {(chip.log[-1][2] - chip.log[0][2]) / 1e6:.1f} s of simulated time")
    return chip


def test_data_go_both_ways_and_every_octet_sent_has_even_parity():
    chip = run()
    octets, parity = chip.octets_sent, chip.parity_sent()
    if len(octets) < 11 * EXCHANGES:  # Data_Exchange is answered by 11 octets
        raise AssertionError(f"only {len(octets)} octets sent")
    # the last answer may not have left the simulator
    expect("parity", parity[:len(octets)], [bin(octet).count("1") & 1 for octet in octets])


def test_a_telegram_with_wrong_parity_is_dropped_and_the_next_ones_are_answered():
    spoilt = 3  # in the first telegram, FDL status
    requests = run(spoilt).requests()
    expect("octets of the first telegram", requests[0].octets, 6)
    expect("octets of the answer to the spoilt telegram", requests[0].answered, 0)
    expect("octets of the answer to its repetition", requests[1].answered, 6)


if __name__ == "__main__":
    handle_short_ack()
    wait_longer()
    sys.exit(run_tests([
        test_data_go_both_ways_and_every_octet_sent_has_even_parity,
        test_a_telegram_with_wrong_parity_is_dropped_and_the_next_ones_are_answered,
    ]))
