"""libmodbus, a client that nobody here wrote, and the inverter's registers that the tests use."""
import ctypes
import ctypes.util
import time

from station import expect

TRIES = 5
EMBXACK = 112345678 + 5                   # errno of libmodbus
RUN = 0                                   # coil
SET_POINT, MAX_FREQ, ACCEL_TIME, STORE = 0, 2, 3, 10  # holding registers
OUTPUT_FREQ = 0                           # input register


class Libmodbus:
    """libmodbus on a line, each call repeated until it is answered."""

    def __init__(self, pty, seconds=0.5):
        """A client that waits so long for an answer."""
        self.lib = ctypes.CDLL(ctypes.util.find_library("modbus"), use_errno=True)
        self.lib.modbus_new_rtu.restype = ctypes.c_void_p
        self.ctx = ctypes.c_void_p(self.lib.modbus_new_rtu(pty.encode(), 19200, ctypes.c_char(b"E"), 8, 1))
        self.lib.modbus_set_slave(self.ctx, 1)
        self.lib.modbus_set_response_timeout(self.ctx, int(seconds), int(seconds % 1 * 1e6))
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
