#!/usr/bin/env python3
"""fieldling-modbus against pymodbus, minimalmodbus and mbpoll on pseudo terminals: RTU and ASCII, diagnostics, several
stations on one line, the inverter alive, its stored parameters, the data image, the console.

Parity stays N: the kernel drops parity on a pty and these clients trip over that (it is tested in virtual time).
"""
import os
import pty
import selectors
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import tty

import minimalmodbus
import serial
from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient
from pymodbus.pdu.file_message import FileRecord

from station import Skip, Station, expect, run_tests

ROUNDS = 30  # of the line with several stations
IMAGE = "host_tests/modbus_image.txt"
UNIT = 17
PATIENCE = 3.0
BREATH = 0.25  # the silence a station must see, on a machine that may not let it run for a while


def station(*arguments, mode="rtu"):
    return Station("fieldling-modbus", "--address", str(UNIT), "--mode", mode, *arguments)


def image(mode="rtu"):
    return station("--map", IMAGE, mode=mode)


class Pymodbus:
    """with Pymodbus(path, mode) as c: a connected client"""

    def __init__(self, path, mode):
        framer = FramerType.ASCII if mode == "ascii" else FramerType.RTU
        self.client = ModbusSerialClient(path, framer=framer, baudrate=19200, parity="N", timeout=PATIENCE, retries=0)

    def __enter__(self):
        if not self.client.connect():
            raise AssertionError("pymodbus did not connect")
        return self.client

    def __exit__(self, *_):
        self.client.close()


def minimal(path, mode="rtu", unit=UNIT):
    instrument = minimalmodbus.Instrument(path, unit, mode=mode)
    instrument.serial.baudrate = 19200
    instrument.serial.timeout = PATIENCE
    return instrument


def good(response):
    if response.isError():
        raise AssertionError(f"pymodbus: {response}")
    return response


def exception(response, code):
    if not response.isError():
        raise AssertionError(f"expected exception {code}, was {response}")
    expect("exception", response.exception_code, code)


# ---- pymodbus --------------------------------------------------------------------------------------------------------

def pymodbus_data(mode):
    with image(mode) as s, Pymodbus(s.pty, mode) as c:
        u = {"device_id": UNIT}
        expect("coils", good(c.read_coils(0, count=2000, **u)).bits[:2000], [False] * 2000)
        good(c.write_coil(3, True, **u))
        good(c.write_coils(8, [True, False, True], **u))
        expect("coils", good(c.read_coils(0, count=16, **u)).bits[:16],
               [i in (3, 8, 10) for i in range(16)])
        expect("inputs", good(c.read_discrete_inputs(0, count=15, **u)).bits[:15], [i % 7 == 0 for i in range(15)])
        expect("input registers", good(c.read_input_registers(10, count=3, **u)).registers, [120, 122, 124])
        good(c.write_register(5, 0xABCD, **u))
        good(c.write_registers(6, [1, 2, 3], **u))
        expect("holding", good(c.read_holding_registers(4, count=6, **u)).registers, [17, 0xABCD, 1, 2, 3, 32])
        good(c.mask_write_register(address=6, and_mask=0xF2, or_mask=0x25, **u))
        expect("masked", good(c.read_holding_registers(6, count=1, **u)).registers, [5])
        expect("23", good(c.readwrite_registers(read_address=20, read_count=2, write_address=20, values=[7, 8],
                                                **u)).registers, [7, 8])
        if mode == "ascii":  # in RTU this client takes two octets less than the answer has (file_message.py)
            expect("fifo", good(c.read_fifo_queue(address=0x4DE, **u)).values, [440, 4740])
        records = good(c.read_file_record([FileRecord(file_number=4, record_number=1, record_length=4)], **u)).records
        expect("file", records[0].record_data, bytes((1, 1, 1, 2)))
        good(c.write_file_record([FileRecord(file_number=4, record_number=3, record_data=b"\x12\x34")],
                                 **u))
        expect("id", good(c.report_device_id(**u)).identifier[:1], b"\xb4")
        expect("identification", good(c.read_device_information(read_code=1, object_id=0, **u)).information[0],
               b"Fieldling")
        expect("status", good(c.read_exception_status(**u)).status, 0)
        exception(c.read_holding_registers(999, count=2, **u), 2)
        exception(c.read_coils(3000, count=1, **u), 2)
        exception(c.read_fifo_queue(address=0, **u), 2)
        exception(c.read_device_information(read_code=4, object_id=0x77, **u), 2)


def test_pymodbus_data_rtu():
    pymodbus_data("rtu")


def test_pymodbus_data_ascii():
    pymodbus_data("ascii")


def pymodbus_diagnostics(mode):
    with image(mode) as s, Pymodbus(s.pty, mode) as c:
        u = {"device_id": UNIT}
        expect("echo", good(c.diag_query_data(b"\xa5\x37", **u)).message, b"\xa5\x37")
        expect("bus messages", good(c.diag_read_bus_message_count(**u)).message, 2)
        expect("bus errors", good(c.diag_read_bus_comm_error_count(**u)).message, 0)
        exception(c.read_coils(9000, count=1, **u), 2)
        expect("exceptions", good(c.diag_read_bus_exception_error_count(**u)).message, 1)
        expect("device messages", good(c.diag_read_device_message_count(**u)).message, 6)
        expect("no response", good(c.diag_read_device_no_response_count(**u)).message, 0)
        expect("nak", good(c.diag_read_device_nak_count(**u)).message, 0)
        expect("busy", good(c.diag_read_device_busy_count(**u)).message, 0)
        expect("overrun", good(c.diag_read_bus_char_overrun_count(**u)).message, 0)
        good(c.diag_clear_overrun_counter(**u))
        expect("register", good(c.diag_read_diagnostic_register(**u)).message, 0)
        exception(c.diag_read_iop_overrun_count(**u), 1)     # 8/19 is reserved
        exception(c.diag_getclear_modbus_response(**u), 1)   # 8/21 too
        exception(c.diag_change_ascii_input_delimeter(delimiter=0x0A, **u), 3)  # in the low octet: wrong
        good(c.diag_change_ascii_input_delimeter(delimiter=0x0A00, **u))
        expect("status", good(c.diag_get_comm_event_counter(**u)).count, 12)
        log = good(c.diag_get_comm_event_log(**u))
        expect("newest events", list(log.events[:4]), [0x80, 0x40, 0x80, 0x40])
        good(c.diag_clear_counters(**u))
        expect("cleared", good(c.diag_read_bus_exception_error_count(**u)).message, 0)
        good(c.diag_restart_communication(True, **u))
        expect("after restart", good(c.diag_get_comm_event_counter(**u)).count, 0)
        c.diag_force_listen_only(no_response_expected=True, **u)
        s.wait(lambda: s.ask("status")["listen_only"] == "1", "listen-only mode")
        c.diag_restart_communication(False, no_response_expected=True, **u)
        s.wait(lambda: s.ask("status")["listen_only"] == "0", "the end of listen-only mode")
        good(c.read_coils(0, count=1, **u))


def test_pymodbus_diagnostics_rtu():
    pymodbus_diagnostics("rtu")


def test_pymodbus_diagnostics_ascii():
    pymodbus_diagnostics("ascii")


# ---- minimalmodbus, mbpoll --------------------------------------------------------------------------------------------

def minimalmodbus_all(mode):
    with image(mode) as s:
        i = minimal(s.pty, mode)
        i.write_bit(3, 1)
        expect("bit", i.read_bit(3, 1), 1)
        expect("inputs", i.read_bits(0, 8, 2), [1, 0, 0, 0, 0, 0, 0, 1])
        i.write_bits(4, [1, 0, 1])
        i.write_register(5, 1234)
        expect("register", i.read_register(5), 1234)
        i.write_register(5, 77.5, number_of_decimals=1, functioncode=6)
        expect("decimal", i.read_register(5, 1), 77.5)
        i.write_long(10, -123456789, signed=True)
        expect("long", i.read_long(10, signed=True), -123456789)
        i.write_float(12, 3.5)
        expect("float", i.read_float(12), 3.5)
        i.write_string(20, "Fieldling", 8)
        expect("string", i.read_string(20, 8).rstrip(), "Fieldling")
        expect("input register", i.read_register(1, functioncode=4), 102)
        try:
            i.read_register(1000)
        except minimalmodbus.IllegalRequestError:
            return
        raise AssertionError("no exception for address 1000")


def test_minimalmodbus_rtu():
    minimalmodbus_all("rtu")


def test_minimalmodbus_ascii():
    minimalmodbus_all("ascii")


def mbpoll(path, *arguments, parity="none"):
    command = ["mbpoll", "-m", "rtu", "-a", str(UNIT), "-b", "19200", "-P", parity, "-0", "-1", "-q", "-o", "3"]
    return subprocess.run([*command, *arguments[:-1], path, *arguments[-1]], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=20, check=False)


def test_mbpoll():
    if not shutil.which("mbpoll"):
        raise Skip("mbpoll is not installed")
    with image() as s:
        for parity in ("none", "even"):
            run = mbpoll(s.pty, "-t", "4", "-r", "10", ["4711", "815"], parity=parity)
            expect("write " + run.stdout, run.returncode, 0)
            run = mbpoll(s.pty, "-t", "4", "-r", "10", "-c", "2", [], parity=parity)
            expect("read " + run.stdout, ("4711" in run.stdout, "815" in run.stdout, run.returncode), (True, True, 0))
        for table, what in (("0", "[7]: \t0"), ("1", "[7]: \t1"), ("3", "[7]: \t114")):
            run = mbpoll(s.pty, "-t", table, "-r", "7", "-c", "1", [])
            expect(run.stdout, what in run.stdout, True)
        run = mbpoll(s.pty, "-t", "0", "-r", "7", ["1"])
        expect("write coil " + run.stdout, run.returncode, 0)
        run = mbpoll(s.pty, "-u", [])
        expect(run.stdout, "test server" in run.stdout, True)
        run = mbpoll(s.pty, "-t", "4", "-r", "2000", "-c", "1", [])
        expect("exit status of an exception", run.returncode, 1)


# ---- several stations on one line ------------------------------------------------------------------------------------

class Hub:
    """One line for several stations and a client: what one says, all others hear."""

    def __init__(self, *paths):
        self.client, self.far = pty.openpty()
        tty.setraw(self.client)
        tty.setraw(self.far)
        self.path = os.ttyname(self.far)
        self.ports = [serial.Serial(path, 19200, timeout=0) for path in paths]
        self.end = False
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        ends = [self.client, *(port.fileno() for port in self.ports)]
        with selectors.DefaultSelector() as selector:
            for fd in ends:
                selector.register(fd, selectors.EVENT_READ)
            while not self.end:
                for key, _ in selector.select(0.05):
                    data = os.read(key.fd, 1024)
                    for fd in ends:
                        if fd != key.fd:
                            os.write(fd, data)

    def noise(self, data):
        for port in self.ports:
            os.write(port.fileno(), data)

    def close(self):
        self.end = True
        self.thread.join()
        for port in self.ports:
            port.close()
        os.close(self.client)
        os.close(self.far)


def several_stations(mode):
    def one(address):
        return Station("fieldling-modbus", "--address", str(address), "--map", IMAGE, "--gap", "8", "--mode", mode)

    with one(1) as a, one(2) as b, one(3) as c:
        hub = Hub(a.pty, b.pty, c.pty)
        units = [minimal(hub.path, mode, address) for address in (1, 2, 3)]
        absent = minimal(hub.path, mode, 9)
        try:
            for n in range(ROUNDS):
                for address, unit in enumerate(units, 1):
                    unit.write_register(50, 1000 * address + n)
                if n % 6 == 1:  # an absent station: the client waits in vain
                    absent.serial.timeout = 0.1
                    try:
                        absent.read_register(0)
                        raise AssertionError("an absent station has answered")
                    except minimalmodbus.NoResponseError:
                        pass
                    absent.serial.timeout = PATIENCE
                if n % 6 == 2:  # a noise octet
                    hub.noise(b"\xff")
                    time.sleep(BREATH)
                if n % 6 == 3:  # a request that breaks off
                    hub.noise(b"\x01\x06\x00\x32\x12" if mode == "rtu" else b":010600321")
                    time.sleep(BREATH)
                for address, unit in enumerate(units, 1):
                    expect("register", unit.read_register(50), 1000 * address + n)
        except minimalmodbus.NoResponseError as error:
            counted = [s.ask("status") for s in (a, b, c)]
            raise AssertionError(f"round {n}: {error}: {[(x['bus_error'], x['slave_message']) for x in counted]}") from None
        finally:
            hub.close()
        for s, address in ((a, 1), (b, 2), (c, 3)):
            expect("requests served", s.ask("status")["slave_message"], str(2 * ROUNDS))
            expect("value", s.ask("get holding-regs 50")["value"], str(1000 * address + ROUNDS - 1))


def test_three_stations_on_one_line_lose_nothing_rtu():
    several_stations("rtu")


def test_three_stations_on_one_line_lose_nothing_ascii():
    several_stations("ascii")


# ---- the inverter -----------------------------------------------------------------------------------------------------

SET_POINT, MAX_FREQ, ACCEL_TIME, DECEL_TIME, BASE_FREQ, STORE = 0, 2, 3, 4, 5, 10  # boards/common/inverter_map.h
OUTPUT_FREQ, TRIP_CODE = 0, 5


def test_inverter_runs_and_stops():
    with station(mode="ascii") as s, Pymodbus(s.pty, "ascii") as c:
        u = {"device_id": UNIT}

        def frequency():
            return good(c.read_input_registers(OUTPUT_FREQ, count=1, **u)).registers[0]

        good(c.write_registers(ACCEL_TIME, [5, 10], **u))
        good(c.write_register(SET_POINT, 3000, **u))
        good(c.write_coil(0, True, **u))
        s.wait(lambda: 0 < frequency() < 3000, "a ramp")
        exception(c.write_register(BASE_FREQ, 6000, **u), 6)  # not while the motor turns
        s.wait(lambda: frequency() == 3000, "the set point")
        s.wait(lambda: good(c.read_exception_status(**u)).status == 0x85, "running, at set point, ready")
        good(c.write_coil(4, True, **u))                      # external trip
        s.wait(lambda: frequency() == 0, "the trip")
        expect("trip code", good(c.read_input_registers(TRIP_CODE, count=1, **u)).registers, [5])
        expect("trip history", good(c.read_fifo_queue(address=0x100, **u)).values, [5])
        exception(c.write_coil(0, True, **u), 4)              # cannot run while tripped
        good(c.write_coil(3, True, **u))
        s.wait(lambda: good(c.read_input_registers(TRIP_CODE, count=1, **u)).registers == [0], "the reset")
        good(c.write_coil(0, True, **u))
        exception(c.write_register(SET_POINT, 50000, **u), 3)
        exception(c.write_register(MAX_FREQ, 50, **u), 3)


def test_inverter_keeps_what_it_stored():
    folder = tempfile.mkdtemp(prefix="fieldling-")
    try:
        nv = os.path.join(folder, "nv")
        with station("--nv", nv) as s, Pymodbus(s.pty, "rtu") as c:
            u = {"device_id": UNIT}
            good(c.write_register(SET_POINT, 4321, **u))
            exception(c.write_register(STORE, 1, **u), 5)     # acknowledge: it goes on by itself
            s.wait(lambda: not c.write_register(SET_POINT, 1111, **u).isError(), "the end of storing")
        with station("--nv", nv) as s:
            expect("set point", s.ask(f"get holding-regs {SET_POINT}")["value"], "4321")
    finally:
        shutil.rmtree(folder, ignore_errors=True)


# ---- the program --------------------------------------------------------------------------------------------------------

def test_console():
    with station() as s:
        status = s.ask("status")
        expect("status", (status["device"], status["mode"], status["address"], status["baud"], status["bus_message"]),
               ("inverter", "rtu", str(UNIT), "19200", "0"))
        expect("set", s.ask("set coils 1 1")["value"], "1")
        expect("get", s.ask("get coils 0x1")["value"], "1")
        for line, reason in (("get coils", "usage-get-table-address"), ("get foo 1", "no-such-table"),
                             ("get coils 99", "no-such-address"), ("get coils x", "address-is-0-to-65535"),
                             ("set coils 0 2", "value-is-0-or-1"), ("set holding-regs 0 65536", "value-is-0-to-65535"),
                             ("status now", "no-argument-expected"), ("trace", "usage-trace-on-or-off"),
                             ("jump", "unknown-command")):
            expect(line, s.ask(line).get("error"), reason)
        expect("trace", s.ask("trace on")["trace"], "on")
        minimal(s.pty).read_register(0)
        s.wait(lambda: len(s.traces) >= 2, "two trace lines")
        expect("request", "frame=110300000001869A check=ok address=17 function=03 data=00000001" in s.traces[0], True)
        expect("answer", s.traces[1].startswith("trace=tx ") and "function=03 data=021388" in s.traces[1], True)
        expect("quit", s.ask("quit")["quit"], "ok")
        expect("exit status", s.process.wait(5), 0)
        expect("link", os.path.lexists(s.pty), False)


def test_the_live_demonstration_ends_well():
    program = os.path.join(os.environ.get("FIELDLING_BIN", "build/posix"), "fieldling-modbus")
    run = subprocess.run(["build/posix/modbus-live", program], text=True, stdin=subprocess.DEVNULL,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, check=False)
    expect(run.stdout, (run.returncode, "50.00 Hz" in run.stdout, ", 0 failed" in run.stdout), (0, True, True))


def run_program(*arguments):
    program = os.path.join(os.environ.get("FIELDLING_BIN", "build/posix"), "fieldling-modbus")
    return subprocess.run([program, *arguments], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, timeout=20, check=False)


def test_unusable_arguments():
    folder = tempfile.mkdtemp(prefix="fieldling-")
    try:
        line = "pty:" + os.path.join(folder, "line")
        bad = os.path.join(folder, "map")
        cases = [[], ["--line", line, "--address", "0"], ["--line", line, "--address", "248"],
                 ["--line", line, "--mode", "tcp"], ["--line", line, "--parity", "X"], ["--line", line, "--baud", "0"],
                 ["--line", line, "--gap", "0"], ["--line", line, "--map", folder + "/none"],
                 ["--line", folder + "/no-such-device"], ["--line", line, "--what"]]
        for text in ("coils 0", "coils 0 0", "coils 65535 2", "coils 0 10 every 0", "coils 0 2 1 0 1", "coils 0 1 2",
                     "input-regs 0 1 65536", "input-regs 0 10 linear 1", "coils 0 10\ncoils 9 2", "words 0 1",
                     "fifo 1 " + "0 " * 32, "file 0 70000", "server-id " + "x" * 250):
            cases.append(["--line", line, "--map", bad, text])
        for arguments in cases:
            if "--map" in arguments and bad in arguments:
                with open(bad, "w", encoding="ascii") as f:
                    f.write(arguments.pop() + "\n")
            run = run_program(*arguments)
            expect(f"{arguments}: status, lines on stderr, {run.stderr}", (run.returncode, run.stderr.count("\n")), (2, 1))
        expect("--help", run_program("--help").returncode, 0)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(run_tests([test for name, test in list(globals().items()) if name.startswith("test_")]))
