#!/usr/bin/env python3
"""The demonstration with a board as the station: its image runs in QEMU, or in s51 for an 8051; the master is a program
on the board's line.

usage: run_board.py BOARD [SECONDS [PROTOCOL]]    PROTOCOL: dp, or modbus on an 8051, with libmodbus as the client
"""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from libmodbus import ACCEL_TIME, MAX_FREQ, OUTPUT_FREQ, RUN, SET_POINT, Libmodbus
from machine import Machine

TOP = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOP / "sim" / "s51"))
from chip_modbus import ModbusChipOnPty  # noqa: E402
from chip_pty import ChipOnPty  # noqa: E402

MASTER = "build/posix/fieldling-master"
RATE = "9600"  # what the station's baud search tries first
IDENT = "0x1234"
DELIVERED = {"com86": 126, "lm3s6965evb": 3, "rv32virt": 126}  # station address of the image
ADDRESS = 8
CHIPS = {"87c51fb": (39, 5)}  # Timer 2's divisor for RATE, address switches
PATIENCE = 5  # seconds for an answer of a simulated chip
GOAL = 3000    # of the inverter [0.01 Hz]


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


def main(board, seconds="10", protocol="dp"):
    if protocol == "modbus":
        if board not in CHIPS:
            raise SystemExit(f"make run PROTOCOL=modbus: not on {board}, but on {', '.join(CHIPS)}")
        return inverter_on_chip(board, float(seconds))
    return on_chip(board, seconds) if board in CHIPS else in_qemu(board, seconds)


def on_chip(board, seconds):
    rate_n, station = CHIPS[board]
    print(f"DP-TEST01 on {board} in s51: the chip looks for its rate", flush=True)
    with ChipOnPty(f"build/{board}/fieldling-dp.ihx", rate_n, switches=station) as chip:
        print(f"{RATE} bit/s; a DP master on its serial port, {chip.pty}\n", flush=True)
        chip.start()
        status = cyclic(chip.pty, station, seconds, slot="1000")
    summary(chip)
    return status


def summary(chip):
    chip.read_log()
    requests = chip.requests()
    print(f"\nthe chip, in {(chip.log[-1][2] - chip.log[0][2]) / 1e6:.1f} s of its time: {len(requests)} telegrams in, "
          f"{sum(request.answered > 0 for request in requests)} answers out")


def turn(client, text, goal, end):
    """Show the drive until it has got to its goal [0.01 Hz]."""
    print(text, flush=True)
    now = None
    while now != goal and time.monotonic() < end:
        time.sleep(0.3)
        now = client.inputs(OUTPUT_FREQ)[0]
        print(f"    read input register {OUTPUT_FREQ}: output {now / 100:5.2f} Hz  {'#' * (now // 100)}", flush=True)


def inverter_on_chip(board, seconds):
    print(f"The Modbus inverter on {board} in s51", flush=True)
    with ModbusChipOnPty(f"build/{board}/fieldling-modbus.ihx", CHIPS[board][0]) as chip:
        print(f"{RATE} bit/s, RTU, address 1; libmodbus on its serial port, {chip.pty}\n", flush=True)
        chip.start()
        with Libmodbus(chip.pty, PATIENCE) as client:
            set_point, least, most = client.holding(SET_POINT, MAX_FREQ + 1)
            print(f"read holding registers 0..2: set point {set_point / 100:.2f} Hz, limits {least / 100:.2f} and {most / 100:.2f} Hz")
            client.write(SET_POINT, GOAL)
            client.write(ACCEL_TIME, 200, 200)
            print("write holding registers 0, 3, 4: set point 30.00 Hz, ramps 20.0 s up and down", flush=True)
            begin = time.monotonic()
            client.coil(RUN, 1)
            turn(client, "write coil 0: run", GOAL, begin + seconds / 2)
            client.coil(RUN, 0)
            turn(client, "write coil 0: stop", 0, begin + seconds)
    summary(chip)
    return 0


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
