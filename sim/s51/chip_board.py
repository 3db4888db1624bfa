"""DP-TEST01's board around the chip: power, address switches, process inputs and outputs, time.

    with Board(image, n=4) as board:      Timer 2's divisor says the rate
        board.power(8)                    on, or off and on again; the RAM keeps its contents, it has a battery
        board.ask("10 08 02 49 53 16")    -> the answer in hex, "" for silence

Marks in a telegram: `02!` comes with wrong parity, `_40` is a pause of 40 bit times after the octet before it.
Simulated time alone: the same run gives the same answers at the same cycles. An output register is a cell in external
RAM to the simulator, and so is the input at the same address: what is written there is noted, and the input put back.

The simulator's console sleeps for 0.1 s when there is nothing to do: what belongs together is said at once.
"""
import os
import re

import chip as s51

OUTPUT = 84  # codes in the simulator's notes: 840000 + value at IO_ADDRESS, 850000 + value behind it
IO_ADDRESS, NV_ADDRESS, NV_SIZE = 0x8000, 0x7FE0, 32  # boards/87c51fb/wiring.h
LOOP = "dp_test01_poll"  # entered once a turn of the main loop
SYN = "phy_syn_ind_isr"  # the line has been silent for T_SYN
TURNS = 3                # of the main loop, and what a telegram has set going is done
SINCE = "expr /L since=sim_ticks"  # what is said is a letter, which is not taken for a note
PATIENCE = 60            # seconds of the host's time for what is done at once


class Board(s51.Chip):
    FOLDER = "87c51fb"  # of its images, below build/

    def __init__(self, image, n, mhz=12, inputs="1E 00"):
        super().__init__(image, mhz=mhz)
        self.n = n
        self.bit = n * 8 / 3                         # machine cycles
        self.cycles_per_ms = mhz * 1000 / s51.CLOCKS
        self.now = 0                                 # machine cycles since power-up
        self.outputs = {}                            # 0, 1 -> the value written last
        self.written = []                            # (cycle, 0 or 1, value)
        self.watches = []
        self.command("var guard\nvar since")
        self.inputs(inputs)

    # ---- what is said to the simulator ----

    def do(self, *lines, seconds=PATIENCE):
        """All of it, then look at the clock."""
        text = self.command("\n".join([*lines, "expr /d 860000", "expr /d sim_ticks"]), seconds)
        self.take_log(text)
        self.now = self.clocks(re.findall(r"^860000\n(-?\d+)$", text, re.M)[-1]) // s51.CLOCKS

    def until(self, label, condition="1"):
        """Lines that run until label is entered: "3" for the third time, "1 if x==2" when x is 2."""
        return self.until_event(f"0x{self.symbols[label]:x} {condition}")

    def until_event(self, event):
        self.breaks += 1
        return f"break {event}", "run", f"delete {self.breaks}"

    def take_note(self, code, value, told):
        if code not in (OUTPUT, OUTPUT + 1):
            super().take_note(code, value, told)
            return
        self.outputs[code - OUTPUT] = value
        self.written.append((self.clocks(told) / s51.CLOCKS, code - OUTPUT, value))

    # ---- the board ----

    def inputs(self, text):
        """Process inputs from now on."""
        lines = [*(f"delete {number}" for number in self.watches), "guard=0"]
        self.watches = []
        for i, value in enumerate(bytes.fromhex(text)):
            put = f"set mem xram 0x{IO_ADDRESS + i:x} 0x{value:x}"
            self.breaks += 1
            self.watches.append(self.breaks)
            lines += [put, f"break xram w 0x{IO_ADDRESS + i:x} 1 if guard==0",
                      f"commands {self.breaks} guard=1;expr /d {(OUTPUT + i) * 10000}+xram[0x{IO_ADDRESS + i:x}];"
                      f"expr /d sim_ticks;{put};guard=0;go"]
        self.do(*lines)

    def out(self):
        return f"{self.outputs.get(0, 256):02X} {self.outputs.get(1, 256):02X}"

    def new_battery(self):
        """What the non-volatile cells held is lost."""
        self.do(f"fill xram 0x{NV_ADDRESS:x} 0x{NV_ADDRESS + NV_SIZE - 1:x} 0x3c")

    def power(self, switches):
        """-> when the baud search has come to this line's rate and the line has been silent for T_SYN. A closed switch
        pulls its pin of P1 to ground."""
        self.log, self.written, self.outputs, self.ticks = [], [], {}, 0
        self.do("fill iram 0 0xff 0xa5", "reset", f"set mem sfr 0x90 0x{~switches & 0x7f | 0x80:x}",
                *self.until(LOOP, f"1 if RCAP2L=={256 - self.n}"), *self.until_later(2 * s51.T_SYN * self.bit))

    # ---- time ----

    def until_later(self, cycles, label=LOOP):
        """Lines that run until label is entered so much later; LOOP: a turn of the main loop begins."""
        return SINCE, *self.until(label, f"1 if sim_ticks-since>={int(cycles * s51.CLOCKS)}")

    def ms(self, n):
        self.do(*self.until_later(n * self.cycles_per_ms), seconds=PATIENCE + n // 20)

    def turns(self, n=TURNS):
        self.do(*self.until(LOOP, str(n)))

    # ---- what the chip knows ----

    def counter(self, name):
        """An FDL counter's low octet."""
        return self.value(f"xram[0x{self.counter_at(name):x}]")

    def last_octet_in(self):
        """When the last octet of the telegram asked last had come, machine cycles."""
        return s51.arrivals(self.log)[-1]

    def turn(self):
        """From there to the first octet of the answer, machine cycles."""
        return [t for kind, _, t in self.log if kind == "TX"][0] - self.last_octet_in()

    # ---- the line ----

    def ask(self, text):
        """Some turns of the main loop have passed since the telegram before, and will have after this one's answer."""
        self.log = []
        part = []
        for token in text.split():
            if token[0] == "_":
                self.pause(bytes(part), int(token[1:]))
                part = []
            else:
                part.append(int(token[:2], 16))
                if token.endswith("!"):
                    self.spoil(len(part))
        return self.ask_octets(bytes(part))

    def ask_octets(self, octets):
        os.write(self.input, octets)
        self.do(*self.until_later(len(octets) * 11 * self.bit, SYN), *self.until(LOOP, TURNS))
        try:
            return os.read(self.output, 4096).hex(" ").upper()
        except BlockingIOError:
            return ""

    def pause(self, octets, bits):
        """The octets, and silence for so long after them. RI is written when the last one has come, and when it is fetched."""
        os.write(self.input, octets)
        last = self.now + (len(octets) * 11 - 2) * self.bit
        came, fetched = 0, 0
        while came < last or fetched < came:
            since = max(0, int((last - self.now) * s51.CLOCKS))
            self.do(SINCE, *self.until_event(f"bits w 0x{s51.RI_BIT:x} 1 if sim_ticks-since>={since}"))
            fetched = max((t for kind, value, t in self.log if kind == "RI" and value == 0), default=0)
            came = max((t for kind, value, t in self.log if kind == "RI" and value == 1), default=0)
            came = max(came, fetched - 12)  # where it has not been seen: arrivals()
        end = came + bits * self.bit
        while end - self.now > self.bit:
            self.do(f"step {int((end - self.now) / 2)}")  # an instruction takes two cycles or less, four at most
