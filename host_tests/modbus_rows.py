#!/usr/bin/env python3
"""Leaving a function out is leaving out its row: each row alone and all rows but one compile without a warning and
link, and what is left out is not in the image."""
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from station import run_tests

BUILD = Path("build/modbus_rows")
ROWS = re.findall(r"ROW\((0x\w+), (\w+), [^)]*\)", Path("firmware/modbus/mb_all_functions.h").read_text())
TEXT = {code: re.search(rf"ROW\({code}, [^)]*\)", Path("firmware/modbus/mb_all_functions.h").read_text()).group(0)
        for code, _ in ROWS}
SOURCES = ["firmware/crc16.c", "firmware/crc16_append.c", *map(str, sorted(Path("firmware/modbus").glob("*.c"))),
           "host_tests/modbus_figures/request.c", "host_tests/modbus_figures/main_pc.c"]
# Handlers share files: each stands in a section of its own, and what no row names is thrown away by the linker.
GCC = ["gcc", "-std=c99", "-O1", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-ffunction-sections", "-fdata-sections",
       "-Wl,--gc-sections", "-Ifirmware", "-Ifirmware/hal/posix", "-Ihost_tests", "-I."]


def image(name, codes, ascii_too):
    """Build with these rows. -> the functions in it"""
    folder = BUILD / name
    folder.mkdir(parents=True, exist_ok=True)
    rows = " ".join(TEXT[code] for code in codes)
    (folder / "mb_rows.h").write_text(f"#define MB_WITH_ASCII {int(ascii_too)}\n#define MB_FUNCTIONS(ROW) {rows}\n")
    run = subprocess.run([*GCC, f"-I{folder}", '-DMB_CONFIG="mb_rows.h"', *SOURCES, "-o", folder / "image"],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120, check=False)
    if run.returncode:
        raise AssertionError(f"{name}: {run.stdout[:400]}")
    symbols = subprocess.run(["nm", folder / "image"], stdout=subprocess.PIPE, text=True, timeout=20, check=True).stdout
    return set(re.findall(r" [Tt] (\w+)", symbols))


def each(make):
    with ThreadPoolExecutor(2) as pool:
        for problem in pool.map(make, ROWS):
            if problem:
                raise AssertionError(problem)


def test_each_row_alone():
    def alone(row):
        code, handler = row
        others = {h for _, h in ROWS} - {handler}
        found = image(f"only_{code}", [code], False)
        extra = (others & found) | {f for f in ("mb_ascii_octet_isr",) if f in found}
        return f"row {code} alone brings {sorted(extra)}" if extra or handler not in found else None
    each(alone)


def test_all_rows_but_one():
    def without(row):
        code, handler = row
        rest = [c for c, _ in ROWS if c != code]
        found = image(f"without_{code}", rest, True)
        needed = {h for c, h in ROWS if c != code}
        return f"without {code}: {handler} is still there" if (handler in found) != (handler in needed) else None
    each(without)


def test_no_diagnostics_no_counting():
    found = image("no_diagnostics", [c for c, _ in ROWS if int(c, 16) not in (8, 11, 12)], True)
    if {"mb_diag_begin", "mb_bad_frame_isr", "mb_log_isr"} & found:
        raise AssertionError("counting and logging without a function that shows it")


if __name__ == "__main__":
    sys.exit(run_tests([test_each_row_alone, test_all_rows_but_one, test_no_diagnostics_no_counting]))
