#!/usr/bin/env python3
"""Unity tests as images of the boards that QEMU has: the module tests, and the contract of the port.

Time in the machine is counted instructions (-icount), so a busy host does not make it late. Each image writes what Unity writes to its console and ends with its status. The line's peer of the contract test
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


def main():
    with open("build/qemu_tests") as file:
        images = file.read().split()
    bad = False
    for path in images:
        status, output = run(path)
        print(f"{path}:\n{output}", flush=True)
        if status != 0 or not re.search(r"^\d+ Tests 0 Failures", output, re.M):
            print(f"{path}: exit status {status}")
            bad = True
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
