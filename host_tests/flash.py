#!/usr/bin/env python3
"""`make flash BOARD=bluepill`: which tool is called, with what, and what is said when that fails. The tools are played:
no probe is needed, and OpenOCD need not be installed."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from station import expect, run_tests

IMAGE = "build/bluepill/fieldling-dp.bin"
OPENOCD = ["-f", "interface/stlink.cfg", "-f", "target/stm32f1x.cfg", "-c", f"program {IMAGE} 0x08000000 verify reset exit"]
ST_FLASH = ["--reset", "write", IMAGE, "0x08000000"]


def flash(tools, status=0, command=("/bin/sh", "boards/bluepill/flash.sh", IMAGE), path="{}"):
    """-> (exit status, lines that were said, {tool: its arguments})"""
    with tempfile.TemporaryDirectory(prefix="fieldling-") as folder:
        for name in tools:
            tool = Path(folder) / name
            tool.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >{folder}/{name}.said\nexit {status}\n', encoding="ascii")
            tool.chmod(0o755)
        environment = {"PATH": path.format(folder)}
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment,
                              check=False, timeout=60)
        called = {said.stem: said.read_text(encoding="ascii").splitlines() for said in Path(folder).glob("*.said")}
    return done.returncode, done.stdout.splitlines(), called


def test_make_flash_builds_the_image_and_calls_openocd():
    status, said, called = flash(["openocd"], command=("make", "-s", "flash", "BOARD=bluepill"), path="{}:" + os.environ["PATH"])
    expect("status", (status, said), (0, []))
    expect("called", called, {"openocd": OPENOCD})
    expect("an image of the part's size", 10000 < os.path.getsize(IMAGE) <= 65536 - 1024, True)  # its last page: the address


def test_openocd_is_preferred():
    expect("called", flash(["openocd", "st-flash"]), (0, [], {"openocd": OPENOCD}))


def test_st_flash_serves_where_openocd_is_not():
    expect("called", flash(["st-flash"]), (0, [], {"st-flash": ST_FLASH}))


def test_without_a_probe_it_says_so():
    for tool, name, arguments in (("openocd", "OpenOCD", OPENOCD), ("st-flash", "st-flash", ST_FLASH)):
        expect(tool, flash([tool], status=1),
               (1, [f"flash: {name} found no ST-Link or no STM32F1 behind it (its words are above)"], {tool: arguments}))


def test_without_a_tool_it_says_which_and_where_the_image_is():
    expect("said", flash([]), (1, ["flash: neither openocd nor st-flash is installed (packages openocd, stlink-tools); "
                                f"the image is {IMAGE}"], {}))


def test_a_board_must_be_named():
    status, said, _ = flash([], command=("make", "-s", "flash"), path=os.environ["PATH"])
    expect("refused", (status, said[0]), (2, "make flash BOARD=bluepill"))


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
