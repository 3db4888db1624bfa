#!/usr/bin/env python3
"""The DP images of the boards that QEMU has, brought up by pyprofibus through the emulated UART.

QEMU runs in host time: a master here repeats what was not answered, like a real one.
"""
import os
import re
import sys
import time

from pyprofibus.phy_serial import CpPhySerial

from interop_pyprofibus import Master, handle_short_ack, number
from machine import Machine
from raw_master import RawMaster
from station import expect, run_tests

EXCHANGES = 300
UNADDRESSED = "10 7E 02 49 C9 16", "10 02 7E 00 80 16"                       # FDL status of 126
SET_ADDRESS_8 = "68 09 09 68 FE 82 6D 37 3E 08 12 34 00 B0 16"               # SAP 55 from 62: 08, ident 1234, changes allowed
STATUS_8 = "10 08 02 49 53 16", "10 02 08 00 0A 16"
STATUS_3 = "10 03 02 49 4E 16", "10 02 03 00 05 16"


def set_address(machine):
    with RawMaster(machine.pty) as master:
        master.wait_for_answer(*UNADDRESSED)
        master.ask(SET_ADDRESS_8, "E5")
        master.wait_for_answer(*STATUS_8)


class PacedPhy(CpPhySerial):
    """A request comes T_SYN after the last octet: 33 bit times, 3.4 ms at the 9600 bit/s that the machines find first."""

    def sendData(self, telegramData, srd):
        time.sleep(0.004)
        super().sendData(telegramData, srd)


def exchange_data(machine, address):
    """This master gives its data again as new ones when two answers are late: no fewer are executed than were given, and
    exactly-once is for the tests in virtual time."""
    with Master(machine.pty, address=address, phy_class=PacedPhy) as master:
        for n in range(1, EXCHANGES + 1):
            master.exchange(number(n))
        machine.wait(lambda: int(machine.ask("out")["out2"]) == EXCHANGES & 0xFF, "the last output")
        status = machine.ask("status")
        expect("state", status["state"], "DATA_EXCH")
        expect("exchanges executed", EXCHANGES <= int(status["data_exchange"]) <= EXCHANGES + 10, True)
        machine.ask("in 1 77")
        for _ in range(50):
            inputs = master.exchange(number(EXCHANGES))
            if inputs[0] == 77:
                return
        raise AssertionError(f"input 77 did not arrive: {inputs.hex()}")


def test_com86_is_given_an_address_and_exchanges_data():
    with Machine("com86", "fieldling-dp") as machine:
        expect("address", machine.ask("status")["address"], "126")
        set_address(machine)
        exchange_data(machine, 8)


def test_com86_keeps_its_address_in_flash_without_power():
    with Machine("com86", "fieldling-dp") as machine:
        set_address(machine)
        machine.process.terminate()
        machine.process.wait()
        with Machine("com86", "fieldling-dp", flash=machine.flash) as again:
            expect("address after power-up", again.ask("status")["address"], "8")
            with RawMaster(again.pty) as master:
                master.wait_for_answer(*STATUS_8)


def test_com86_line_is_8e1_and_the_driver_is_on_for_the_answer_only():
    with Machine("com86", "fieldling-dp", trace=("serial_update_parameters", "serial_write")) as machine:
        set_address(machine)
        machine.process.terminate()
        machine.process.wait()
        with open(machine.events) as file:
            events = file.read()
    formats = re.findall(r"parity='(.)' data=(\d) stop=(\d)", events)
    expect("format of the line", ("E", "8", "1") in formats, True)
    # offset 4 is the modem control register: 0B with RTS, 09 without; offset 0 the octets
    writes = [(int(a, 16), int(v, 16)) for a, v in re.findall(r"write addr (0x[0-9a-f]+) val (0x[0-9a-f]+)", events)]
    edges = [value for address, value in writes if address == 4 and value in (0x09, 0x0B)]
    expect("driver goes on and off in turn", edges[edges.index(0x0B):][:2], [0x0B, 0x09])
    on = False
    sent = 0
    for address, value in writes:
        if address == 4:
            on = value == 0x0B
        elif address == 0 and on:
            sent += 1
    expect("octets sent with the driver on", sent >= 6 + 1 + 6, True)


def test_rv32virt_is_given_an_address_and_exchanges_data():
    with Machine("rv32virt", "fieldling-dp") as machine:
        set_address(machine)
        exchange_data(machine, 8)


def test_lm3s6965evb_exchanges_data():
    with Machine("lm3s6965evb", "fieldling-dp") as machine:
        exchange_data(machine, 3)


def test_lm3s6965evb_line_is_8e1():
    with Machine("lm3s6965evb", "fieldling-dp", trace=("pl011_write",)) as machine:
        machine.process.terminate()
        machine.process.wait()
        with open(machine.events) as file:
            formats = re.findall(r"pl011_write addr 0x0*2c value 0x0*([0-9a-f]+)", file.read())
    # UARTLCRH: 40H 7 bits, 60H 8 bits, 06H even parity. The console's is set first
    expect("formats", (formats[0], set(formats[1:])), ("60", {"66"}))


def test_lm3s6965evb_driver_pin_is_on_for_the_answer_only():
    with Machine("lm3s6965evb", "fieldling-dp", trace=("pl061_set_output",)) as machine:
        with RawMaster(machine.pty) as master:
            master.wait_for_answer(*STATUS_3)

        def levels_seen():
            with open(machine.events) as file:
                return re.findall(r"pl061_set_output .* setting output (\d) to (\d)", file.read())

        machine.wait(lambda: levels_seen()[-1:] == [("4", "0")], "the driver off")
        levels = levels_seen()
    expect("driver went on and off", levels[:2], [("4", "1"), ("4", "0")])
    expect("driver is off at the end", levels[-1], ("4", "0"))


if __name__ == "__main__":
    handle_short_ack()
    os.environ.setdefault("QEMU_AUDIO_DRV", "none")
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
