#!/usr/bin/env python3
"""The Modbus images of the boards that QEMU has, driven by libmodbus, mbpoll and minimalmodbus through the emulated UART.

QEMU runs in host time, and a frame that the host cut in two is dropped, as the standard wants: clients here repeat what
was not answered, a bounded number of times, like any real one.
"""
import re
import shutil
import subprocess
import sys

import minimalmodbus

from libmodbus import ACCEL_TIME, MAX_FREQ, OUTPUT_FREQ, RUN, SET_POINT, STORE, TRIES, Libmodbus
from machine import Machine
from station import Skip, expect, run_tests


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
