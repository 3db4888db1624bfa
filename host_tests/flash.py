#!/usr/bin/env python3
"""`make flash BOARD=...`: which tool is called, with what, and what is said when that fails. The tools are played: no probe is
needed, and none of them need be installed."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from station import expect, run_tests

IMAGE = "build/bluepill/fieldling-dp.bin"
OPENOCD = ["-f", "interface/stlink.cfg", "-f", "target/stm32f1x.cfg", "-c", f"program {IMAGE} 0x08000000 verify reset exit"]
ST_FLASH = ["--reset", "write", IMAGE, "0x08000000"]

STC_IMAGE, PORT = "build/stc89c58rd/fieldling-modbus.bin", "/dev/null"
STCGAL = ["-P", "stc89", "-p", PORT, "-o", "cpu_6t_enabled=false", "-o", "clock_gain=high", "-o", "ale_enabled=true",
          "-o", "xram_enabled=true", "-o", "watchdog_por_enabled=false", "-o", "eeprom_erase_enabled=false", STC_IMAGE]
MINIPRO_IMAGE = "build/87c51fb/fieldling-dp.bin"
MINIPRO = ["-p", "AT89C55WD", "-s", "-w", MINIPRO_IMAGE]


def flash(tools, status=0, command=("/bin/sh", "boards/bluepill/flash.sh", IMAGE), path="{}", cwd="."):
    """-> (exit status, lines that were said, {tool: its arguments})"""
    with tempfile.TemporaryDirectory(prefix="fieldling-") as folder:
        for name in tools:
            tool = Path(folder) / name
            tool.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >{folder}/{name}.said\nexit {status}\n', encoding="ascii")
            tool.chmod(0o755)
        environment = {"PATH": path.format(folder)}
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment, cwd=cwd,
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


def make(tool, *arguments):
    return flash([tool], command=("make", "-s", "flash", *arguments), path="{}:" + os.environ["PATH"])


def stc(tools, port=PORT, status=0):
    """In a folder of its own: build/venv may have a real stcgal."""
    with tempfile.TemporaryDirectory(prefix="fieldling-") as folder:
        script = os.path.abspath("boards/stc89c58rd/flash.sh")
        return flash(tools, status, command=("/bin/sh", script, STC_IMAGE, port), cwd=folder)


def test_stcgal_programs_the_stc89():
    expect("called", make("stcgal", "BOARD=stc89c58rd", f"PORT={PORT}", "IMAGE=fieldling-modbus"), (0, [], {"stcgal": STCGAL}))


def test_without_stcgal_port_or_part_it_says_so():
    expect("no stcgal", stc([]), (1, ["flash: stcgal is not installed (build/venv/bin/pip install stcgal==1.10); "
                                      f"the image is {STC_IMAGE}"], {}))
    expect("no port", stc(["stcgal"], port="/dev/none"),
           (1, ["flash: there is no serial port /dev/none (make flash BOARD=stc89c58rd PORT=/dev/...)"], {}))
    expect("no part", stc(["stcgal"], status=1),
           (1, [f"flash: stcgal could not program the part on {PORT} (its words are above)"], {"stcgal": STCGAL}))


def test_minipro_programs_a_part_for_the_87c51fb_s_socket():
    expect("called", make("minipro", "BOARD=87c51fb"), (0, [], {"minipro": MINIPRO}))


def test_without_minipro_or_programmer_it_says_so():
    script = ("/bin/sh", "boards/87c51fb/flash.sh", MINIPRO_IMAGE, "AT89C55WD")
    expect("no minipro", flash([], command=script),
           (1, ["flash: minipro is not installed (Debian 12 has no package of it); "
                f"the image is {MINIPRO_IMAGE}"], {}))
    expect("no programmer", flash(["minipro"], status=1, command=script),
           (1, ["flash: minipro found no programmer or no AT89C55WD in it (its words are above)"], {"minipro": MINIPRO}))


def test_a_board_must_be_named():
    status, said, _ = flash([], command=("make", "-s", "flash"), path=os.environ["PATH"])
    expect("refused", (status, said[0]), (2, "make flash BOARD=bluepill, 87c51fb or stc89c58rd"))


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
