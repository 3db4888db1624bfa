#!/usr/bin/env python3
"""Keeps firmware/modbus/README.md true: its tables are those of the code, its example compiles and runs.

usage: modbus_readme.py            test
       modbus_readme.py --write    put the tables into the README
"""
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import minimalmodbus

from station import expect, run_tests

README = Path("firmware/modbus/README.md")
BUILD = Path("build/modbus_readme")
C = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-D_POSIX_C_SOURCE=200809L", "-D_DEFAULT_SOURCE", "-I.", "-Ifirmware",
     "-Ifirmware/hal/posix", f"-I{BUILD}"]


def tables():
    BUILD.mkdir(parents=True, exist_ok=True)
    program = BUILD / "tables"
    subprocess.run([*C, '-DMB_CONFIG="boards/common/inverter_mb.h"', "host_tests/modbus_tables.c", "-o", program],
                   check=True, timeout=60)
    text = subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True, timeout=10).stdout
    return re.findall(r"<!-- \w+ -->\n.*?<!-- end -->", text, re.S)


def put_in(text):
    for table in tables():
        first = table.splitlines()[0]
        text, n = re.subn(re.escape(first) + r".*?<!-- end -->", lambda _, t=table: t, text, flags=re.S)
        expect(f"places for {first}", n, 1)
    return text


def test_tables_are_those_of_the_code():
    if put_in(README.read_text()) != README.read_text():
        raise AssertionError("run host_tests/modbus_readme.py --write")


MAIN = """#include "hal_host.h"
int own_main(void);
int main(int argc, char **argv)
{
    const struct hal_host host = {.line = argc > 1 ? argv[1] : ""};
    return hal_host_open(&host) ? 2 : own_main();
}
"""


def test_example_compiles_and_runs():
    header, program = re.findall(r"```c\n(.*?)```", README.read_text(), re.S)[:2]
    BUILD.mkdir(parents=True, exist_ok=True)
    (BUILD / "my_mb.h").write_text(header)
    (BUILD / "own.c").write_text(program.replace("int main(", "int own_main("))
    (BUILD / "main.c").write_text(MAIN)
    expect("lines of the example at most", len(program.strip().splitlines()) <= 42, True)
    stack = ["firmware/crc16.c", "firmware/crc16_append.c", *map(str, Path("firmware/modbus").glob("mb_*.c"))]
    defaults = [str(p) for p in Path("firmware/modbus").glob("default_*.c")]
    port = [f"firmware/hal/posix/{name}.c" for name in ("hal_realtime", "line_pty", "line_tty", "nv_file", "con_stdio")]
    for source in defaults:
        subprocess.run([*C, '-DMB_CONFIG="my_mb.h"', "-c", source, "-o", BUILD / (Path(source).stem + ".o")], check=True,
                       timeout=60)
    archive = BUILD / "defaults.a"
    archive.unlink(missing_ok=True)
    subprocess.run(["ar", "rcs", archive, *[BUILD / (Path(s).stem + ".o") for s in defaults]], check=True, timeout=60)
    subprocess.run([*C, '-DMB_CONFIG="my_mb.h"', BUILD / "own.c", BUILD / "main.c", *stack, *port, archive, "-o",
                    BUILD / "own"], check=True, timeout=100)
    with tempfile.TemporaryDirectory(prefix="fieldling-") as folder:
        line = os.path.join(folder, "line")
        process = subprocess.Popen([BUILD / "own", "pty:" + line], stdin=subprocess.DEVNULL)
        try:
            end = time.monotonic() + 10
            while not os.path.islink(line) and time.monotonic() < end:
                time.sleep(0.01)
            client = minimalmodbus.Instrument(line, 17)
            client.serial.baudrate = 19200
            client.serial.timeout = 3
            client.write_register(0, 1234)
            expect("speed", client.read_registers(0, 2), [1234, 0])
            client.write_bit(7, 1)
            expect("lamp", client.read_bit(7, 1), 1)
            try:
                client.write_register(0, 3001)
                raise AssertionError("3001 was taken")
            except minimalmodbus.IllegalRequestError:
                pass
            expect("speed", client.read_register(0), 1234)
        finally:
            process.kill()
            process.wait()


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        README.write_text(put_in(README.read_text()))
        sys.exit(0)
    sys.exit(run_tests([test_tables_are_those_of_the_code, test_example_compiles_and_runs]))
