"""The STC89C58RD+ board's images in the simulator s51, a 24 MHz 8052 with the data flash played (data_flash.py).

s51 has external RAM everywhere; that an image stays in what the part has is the linker's to say. The watchdog and AUXR are
plain cells here.
"""
import data_flash
from chip_board import Board
from chip_modbus import ModbusChip

MHZ = 24
ADDRESS, OPEN = 1, 0
AUXR, P0, P1 = 0x8E, 0x80, 0x90


class StcBoard(Board):
    """With RAM on the bus: DP."""
    FOLDER = "stc89c58rd"

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        data_flash.play(self)

    def new_battery(self):
        """What the non-volatile cells held is lost."""
        self.do(data_flash.blank())


class StcModbus(ModbusChip):
    """Alone: Modbus, with the line's switches at P0."""

    def __init__(self, image, rate_n, line=OPEN):
        super().__init__(image, rate_n, line, mhz=MHZ)

    def wait_for_rate(self, n):
        data_flash.play(self)
        self.set_switches()
        super().wait_for_rate(n)

    def set_switches(self):
        """A closed switch pulls its pin to ground."""
        self.command(f"set mem sfr 0x{P0:x} 0x{~self.line & 0xff:x}\nset mem sfr 0x{P1:x} 0x{~ADDRESS & 0xff:x}")

    def power(self):
        """Off and on again: RAM is lost, the data flash is not."""
        self.command("fill iram 0 0xff 0xa5\nfill xram 0 0x3ff 0xa5\nreset")
        self.set_switches()
        self.run_to("line_silence_isr")
        self.run_to("mb_poll")
