#!/usr/bin/env python3
"""Unity tests as images of the boards that QEMU has: the module tests, and the contract of the port.

Time in the machine is counted instructions (-icount) while it runs, and the host's while it sleeps. Each image writes what Unity writes to its console and ends with its status. The line's peer of the contract test
(host_tests/hal_contract.h) is here: what the line has heard goes back after a silence.
"""
import os
import pty
import re
import select
import subprocess
import sys
import time
import tty
from pathlib import Path

from machine import BOARDS, qemu

ECHO_AFTER = 0.030
PATIENCE = 60.0
TRIES = 3


def run(path):
    """-> (what the test's main() returned, output) of the image build/BOARD/x; its line hears its own echo."""
    board = Path(path).parent.name
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    command = qemu(board, path, console="stdio,id=console,signal=off", line=f"serial,id=line,path={os.ttyname(theirs)}",
                   more=("-icount", "shift=5"))
    end = time.monotonic() + PATIENCE
    heard = b""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        output = b""
        while time.monotonic() < end:
            ready = select.select([ours, process.stdout], [], [], ECHO_AFTER)[0]
            if ours in ready:
                heard += os.read(ours, 4096)
            elif heard:
                os.write(ours, heard)
                heard = b""
            if process.stdout in ready:
                more = os.read(process.stdout.fileno(), 4096)
                if not more:
                    break
                output += more
        else:
            process.kill()
        status = process.wait() >> BOARDS[board].exit_shift
    os.close(ours)
    os.close(theirs)
    return status, output.decode(errors="replace").replace("\r", "")


def passed(status, output):
    return status == 0 and re.search(r"^\d+ Tests 0 Failures", output, re.M)


def tried(path):
    """The contract's image sleeps in the host's time, and a busy host wakes it late: what fails there is asked again."""
    for left in reversed(range(TRIES if path.split("/")[-1].startswith("hal_contract.") else 1)):
        status, output = run(path)
        if passed(status, output) or not left:
            return status, output
        print(f"{path}: failed, and is tried again", flush=True)


def main():
    with open("build/qemu_tests") as file:
        images = file.read().split()
    bad = False
    for path in images:
        status, output = tried(path)
        print(f"{path}:\n{output}", flush=True)
        if not passed(status, output):
            print(f"{path}: exit status {status}")
            bad = True
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
