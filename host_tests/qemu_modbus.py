#!/usr/bin/env python3
"""The Modbus images of the boards that QEMU has, driven by libmodbus, mbpoll and minimalmodbus through the emulated UART.

QEMU runs in host time, and a frame that the host cut in two is dropped, as the standard wants: clients here repeat what
was not answered, a bounded number of times, like any real one.
"""
import ctypes
import ctypes.util
import re
import shutil
import subprocess
import sys
import time

import minimalmodbus

from machine import Machine
from station import Skip, expect, run_tests

TRIES = 5
EMBXACK = 112345678 + 5                   # errno of libmodbus
RUN = 0                                   # coil
SET_POINT, MAX_FREQ, ACCEL_TIME, STORE = 0, 2, 3, 10  # holding registers
OUTPUT_FREQ = 0                           # input register


class Libmodbus:
    """libmodbus on a line, each call repeated until it is answered."""

    def __init__(self, pty):
        self.lib = ctypes.CDLL(ctypes.util.find_library("modbus"), use_errno=True)
        self.lib.modbus_new_rtu.restype = ctypes.c_void_p
        self.ctx = ctypes.c_void_p(self.lib.modbus_new_rtu(pty.encode(), 19200, ctypes.c_char(b"E"), 8, 1))
        self.lib.modbus_set_slave(self.ctx, 1)
        self.lib.modbus_set_response_timeout(self.ctx, 0, 500000)
        expect("connection", self.lib.modbus_connect(self.ctx), 0)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lib.modbus_close(self.ctx)
        self.lib.modbus_free(self.ctx)

    def call(self, name, *arguments):
        for _ in range(TRIES):
            result = getattr(self.lib, name)(self.ctx, *arguments)
            if result >= 0:
                return result
            time.sleep(0.01)
        raise AssertionError(f"{name}{arguments}: no good answer in {TRIES} tries, errno {ctypes.get_errno()}")

    def acknowledged(self, name, *arguments):
        """The answer is exception 05: accepted, takes its time."""
        for _ in range(TRIES):
            expect("success", getattr(self.lib, name)(self.ctx, *arguments), -1)
            if ctypes.get_errno() == EMBXACK:
                return
        raise AssertionError(f"{name}{arguments}: not acknowledged in {TRIES} tries, errno {ctypes.get_errno()}")

    def holding(self, address, n=1):
        values = (ctypes.c_uint16 * n)()
        expect("registers", self.call("modbus_read_registers", address, n, values), n)
        return list(values)

    def inputs(self, address, n=1):
        values = (ctypes.c_uint16 * n)()
        expect("registers", self.call("modbus_read_input_registers", address, n, values), n)
        return list(values)

    def write(self, address, *values):
        array = (ctypes.c_uint16 * len(values))(*values)
        expect("registers", self.call("modbus_write_registers", address, len(values), array), len(values))

    def coil(self, address, on):
        expect("coil", self.call("modbus_write_bit", address, on), 1)


def libmodbus_runs_the_inverter(board):
    with Machine(board, "fieldling-modbus") as machine, Libmodbus(machine.pty) as client:
        expect("defaults", client.holding(SET_POINT, 3), [5000, 0, 6000])
        client.write(SET_POINT, 1234)
        client.write(ACCEL_TIME, 1, 1)
        client.coil(RUN, 1)
        machine.wait(lambda: client.inputs(OUTPUT_FREQ) == [1234], "the set point")
        expect("frequency", machine.ask("status")["frequency"], "1234")
        client.coil(RUN, 0)
        machine.wait(lambda: client.inputs(OUTPUT_FREQ) == [0], "the stop")
        for n in range(100):
            client.write(SET_POINT, 100 + n)
            expect("set point", client.holding(SET_POINT), [100 + n])
        status = machine.ask("status")
        expect("messages", int(status["slave_message"]) >= 200, True)
        expect("few errors", int(status["bus_error"]) < 20, True)


def test_libmodbus_runs_the_inverter_on_com86():
    libmodbus_runs_the_inverter("com86")


def test_libmodbus_runs_the_inverter_on_rv32virt():
    libmodbus_runs_the_inverter("rv32virt")


def test_libmodbus_runs_the_inverter_on_lm3s6965evb():
    libmodbus_runs_the_inverter("lm3s6965evb")


def test_com86_keeps_stored_parameters_in_flash_without_power():
    with Machine("com86", "fieldling-modbus") as machine:
        with Libmodbus(machine.pty) as client:
            client.write(SET_POINT, 4321)
            client.acknowledged("modbus_write_register", STORE, 1)
            stored = lambda: client.lib.modbus_write_register(client.ctx, STORE, 0) == 1  # busy (06) before it
            machine.wait(stored, "the end of storing")
        machine.process.terminate()
        machine.process.wait()
        with Machine("com86", "fieldling-modbus", flash=machine.flash) as again, Libmodbus(again.pty) as client:
            expect("set point after power-up", client.holding(SET_POINT), [4321])


def mbpoll_reads(board):
    if not shutil.which("mbpoll"):
        raise Skip("mbpoll is not installed")
    with Machine(board, "fieldling-modbus") as machine:
        for _ in range(TRIES):
            run = subprocess.run(["mbpoll", "-m", "rtu", "-a", "1", "-b", "19200", "-P", "even", "-0", "-1", "-q", "-o", "1",
                                  "-t", "4", "-r", "0", "-c", "3", machine.pty], text=True, stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT, timeout=20, check=False)
            if run.returncode == 0:
                break
        expect(run.stdout, re.findall(r"\[\d+\]:\s*(\d+)", run.stdout), ["5000", "0", "6000"])


def test_mbpoll_reads_com86():
    mbpoll_reads("com86")


def test_mbpoll_reads_lm3s6965evb():
    mbpoll_reads("lm3s6965evb")


def ascii_is_served(board):
    with Machine(board, "fieldling-modbus") as machine:
        expect("mode", machine.ask("ascii")["mode"], "ascii")
        client = minimalmodbus.Instrument(machine.pty, 1, minimalmodbus.MODE_ASCII)
        client.serial.baudrate = 19200
        client.serial.timeout = 2.0
        client.close_port_after_each_call = False
        for n in range(20):
            for attempt in range(TRIES):
                try:
                    client.write_register(SET_POINT, n, functioncode=6)
                    expect("set point", client.read_register(SET_POINT), n)
                    break
                except (minimalmodbus.NoResponseError, minimalmodbus.InvalidResponseError):
                    # late or cut off by this client's time-out, on a busy host: asked again, as masters do
                    if attempt == TRIES - 1:
                        raise
        client.serial.close()


def test_ascii_on_com86():
    ascii_is_served("com86")


def test_ascii_on_lm3s6965evb():
    ascii_is_served("lm3s6965evb")


def test_com86_line_is_8e1_and_7e1_for_ascii():
    with Machine("com86", "fieldling-modbus", trace=("serial_update_parameters",)) as machine:
        machine.ask("ascii")
        machine.process.terminate()
        machine.process.wait()
        with open(machine.events) as file:
            formats = re.findall(r"baudrate=(\d+) parity='(.)' data=(\d) stop=(\d)", file.read())
    expect("RTU", ("19200", "E", "8", "1") in formats, True)
    expect("ASCII", formats[-1], ("19200", "E", "7", "1"))


def test_lm3s6965evb_line_is_8e1_and_7e1_for_ascii():
    with Machine("lm3s6965evb", "fieldling-modbus", trace=("pl011_write",)) as machine:
        machine.ask("ascii")
        machine.process.terminate()
        machine.process.wait()
        with open(machine.events) as file:
            formats = re.findall(r"pl011_write addr 0x0*2c value 0x0*([0-9a-f]+)", file.read())
    expect("UARTLCRH of console, RTU, ASCII", formats, ["60", "66", "46"])


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
