#!/usr/bin/env python3
"""The demonstration with a board as the station: its image runs in QEMU, or in s51 for an 8051; the master is a program
on the board's line.

usage: run_board.py BOARD [SECONDS]
"""
import subprocess
import sys
import tempfile
from pathlib import Path

from machine import Machine

TOP = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "sim" / "s51"))
from chip_pty import ChipOnPty  # noqa: E402

MASTER = "build/posix/fieldling-master"
RATE = "9600"  # what the station's baud search tries first
IDENT = "0x1234"
DELIVERED = {"com86": 126, "lm3s6965evb": 3, "rv32virt": 126}  # station address of the image
ADDRESS = 8
CHIPS = {"87c51fb": (39, 5)}  # Timer 2's divisor for RATE, address switches


def master(pty, *arguments, slot="100"):
    command = [MASTER, "--line", pty, "--rate", RATE, "--retries", "5", "--slot", slot, *arguments]
    return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode


def cyclic(pty, station, seconds, **options):
    """A simulated board on a busy computer may be late: its watchdog is longer than the slot time."""
    with tempfile.NamedTemporaryFile("w", suffix=".dp") as setup:
        setup.write(f"slave {station}\n gsd {TOP}/gsd/FLDL1234.GSD\n watchdog 20000\n")
        setup.flush()
        return master(pty, "--count", "--seconds", seconds, "cyclic", setup.name, **options)


def set_address(machine, old):
    """The station must have found the rate first."""
    for _ in range(20):
        if machine.ask("status")["address"] == str(ADDRESS):
            return
        master(machine.pty, "set-address", str(old), str(ADDRESS), IDENT)
    raise SystemExit("the station did not take its address")


def main(board, seconds="10"):
    return on_chip(board, seconds) if board in CHIPS else in_qemu(board, seconds)


def on_chip(board, seconds):
    rate_n, station = CHIPS[board]
    print(f"DP-TEST01 on {board} in s51: the chip looks for its rate", flush=True)
    with ChipOnPty(f"build/{board}/fieldling-dp.ihx", rate_n, switches=station) as chip:
        print(f"{RATE} bit/s; a DP master on its serial port, {chip.pty}\n", flush=True)
        chip.start()
        status = cyclic(chip.pty, station, seconds, slot="1000")
    chip.read_log()
    requests = chip.requests()
    print(f"\nthe chip, in {(chip.log[-1][2] - chip.log[0][2]) / 1e6:.1f} s of its time: {len(requests)} telegrams in, "
          f"{sum(request.answered > 0 for request in requests)} answers out")
    return status


def in_qemu(board, seconds):
    with Machine(board, "fieldling-dp") as machine:
        print(f"DP-TEST01 on {board} in QEMU, a DP master on its second serial port, {machine.pty}\n", flush=True)
        if DELIVERED[board] == 126:
            print(f"Set_Slave_Add: {DELIVERED[board]} -> {ADDRESS}", flush=True)
            set_address(machine, DELIVERED[board])
            station = ADDRESS
        else:
            station = DELIVERED[board]
        machine.ask("in 1 31")
        status = cyclic(machine.pty, station, seconds)
        said = machine.ask("status")
        print("\nthe board's console: " + " ".join(f"{key}={value}" for key, value in said.items()))
        return status if said["state"] in ("DATA_EXCH", "WAIT_PRM") and int(said["data_exchange"]) > 0 else 1


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
