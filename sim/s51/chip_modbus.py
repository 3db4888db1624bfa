"""The Modbus inverter's image in the simulator s51: its line switches, and one request at a time."""
import os

from chip import Chip, Exchange
from chip_pty import ChipOnPty

IO_ADDRESS = 0x8000
# line switches, boards/common/main_mcs51_modbus.c
RATE_9600, ODD, NONE, ASCII = 4, 0x08, 0x10, 0x20


class _Modbus:
    line = 0  # switches

    def wait_for_rate(self, n):
        """Until the line is open at Timer 2's divisor n and has been silent for t3.5."""
        self.command(f"set mem xram 0x{IO_ADDRESS:x} 0x{self.line:x}\nodd={int(self.line & 0x18 == ODD)}")
        if not self.line & ASCII:
            self.run_to("line_silence_isr")
        self.run_to("mb_poll")
        if self.value("RCAP2L") != 256 - n:
            raise AssertionError(f"Timer 2's divisor is {256 - self.value('RCAP2L')}, not {n}")


class ModbusChip(_Modbus, Chip):
    def __init__(self, image, rate_n, line=0, mhz=12):
        super().__init__(image, mhz=mhz, switches=1)
        self.line = line
        self.wait_for_rate(rate_n)
        self.watch("0x0b", "expr /d 840000;expr /d sim_ticks")  # the vector of Timer 0
        self.watch_driver()

    def watch_idle(self):
        """Note the end of each pass of the main loop."""
        self.watch(f"0x{self.symbols['hal_idle']:x}", "expr /d 890001;expr /d sim_ticks")

    def ask(self, request, passes=1):
        """Send request, passes of the main loop from now; run until its answer has left. -> Exchange"""
        for _ in range(passes):
            self.run_to("mb_poll")
        self.log = []
        os.write(self.input, request)
        self.run_to("line_sent_isr")
        return Exchange(self.log, os.read(self.output, 4096))

    def tell(self, request):
        """Send a request that must not be answered; run until its frame has ended and main has looked. -> octets sent"""
        self.log = []
        os.write(self.input, request)
        self.run_to("mb_frame_end_isr")
        for _ in range(5):
            self.run_to("mb_poll")
        return sum(kind == "TX" for kind, _, _ in self.log)


class ModbusChipOnPty(_Modbus, ChipOnPty):
    def ask(self, _):
        """Nothing to be found out before a client comes."""

    def __init__(self, image, rate_n):
        super().__init__(image, rate_n, switches=1)
