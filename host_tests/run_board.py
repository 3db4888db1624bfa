#!/usr/bin/env python3
"""The demonstration with a board as the station: its image runs in QEMU, the master is a program on the board's line.

usage: run_board.py BOARD [SECONDS]
"""
import subprocess
import sys

from machine import Machine

MASTER = "build/posix/fieldling-master"
RATE = "9600"  # what the station's baud search tries first
IDENT = "0x1234"
DELIVERED = {"com86": 126, "lm3s6965evb": 3}  # station address of the image
ADDRESS = 8


def master(pty, *arguments):
    command = [MASTER, "--line", pty, "--rate", RATE, "--retries", "5", "--slot", "100", *arguments]
    return subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode


def set_address(machine, old):
    """The station must have found the rate first."""
    for _ in range(20):
        if machine.ask("status")["address"] == str(ADDRESS):
            return
        master(machine.pty, "set-address", str(old), str(ADDRESS), IDENT)
    raise SystemExit("the station did not take its address")


def main(board, seconds="10"):
    with Machine(board, "fieldling-dp") as machine:
        print(f"DP-TEST01 on {board} in QEMU, a DP master on its second serial port, {machine.pty}\n", flush=True)
        if DELIVERED[board] == 126:
            print(f"Set_Slave_Add: {DELIVERED[board]} -> {ADDRESS}", flush=True)
            set_address(machine, DELIVERED[board])
            station = ADDRESS
        else:
            station = DELIVERED[board]
        machine.ask("in 1 31")
        status = master(machine.pty, "--slave", f"{station}=gsd/FLDL1234.GSD", "--count", "--seconds", seconds, "cyclic")
        said = machine.ask("status")
        print("\nthe board's console: " + " ".join(f"{key}={value}" for key, value in said.items()))
        return status if said["state"] in ("DATA_EXCH", "WAIT_PRM") and int(said["data_exchange"]) > 0 else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
