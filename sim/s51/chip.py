"""An image in the simulator s51 (uCsim), its serial port in our hands, time in machine cycles.

The simulated time does not depend on the host: a telegram is put into the receiver's FIFO while the simulation stands,
and what happens is written down by the simulator itself, at the instruction where it happens.

What s51 0.6.4 does not model is supplied or corrected here:
  ninth bit   RB8 of a received octet is set by a script at the moment RI is written: even parity, or wrong on purpose;
              TB8 of a sent octet is noted when SBUF is written; odd=1 at the console turns the parity of received octets round
  input       is looked at every million instructions unless uart0_check_often is set
  RI, TI      come at the end of the character; on the real part RI comes half a bit and TI one bit earlier
  sim_ticks   is told with 32 bits and a sign: clocks() puts up with it; sums in conditions do not, 178 s after a reset at 24 MHz
"""
import os
import re
import select
import shutil
import subprocess
import tempfile
import time

CLOCKS = 12  # a machine cycle
T_SYN = 33   # T_bit
PARITY = ("^".join(f"(uart0_received_char>>{n})" for n in range(8))).join(("(", ")&1"))
RI_BIT, P3_2_BIT, SBUF = 0x98, 0xB2, 0x99
DRIVER = "(((P3>>2)&1)^1)"  # is it on? A port is high in reset: an inverter makes that the driver off
# What is noted: a line with 10000 times one of these and a value, and a line with the time in clocks. INT: an interrupt
# is entered or left. AT: now; 1: a pass of the main loop ends. Then, where asked for, BUSY and the clocks in interrupts.
KINDS = {81: "RI", 82: "TX", 83: "DE", 84: "T0", 88: "INT", 89: "AT"}
BUSY = "expr /d 800000;expr /d sim_isr_ticks"
ENTRY, RETI = 4, 2  # machine cycles on the real part: its call of the vector and the jump there; the return
# struct fdl_counters, 16 bits each: firmware/fdl/fdl.h
FDL_COUNTERS = ("sd_count sd_error_count parity overrun gap format checksum foreign requests retries answers cancelled "
                "refused").split()


class Stuck(Exception):
    """The simulator said nothing in time, or never came to where it was sent."""


def symbols(image):
    """Global labels of the image's map file: in code, and in external RAM."""
    found = {}
    with open(image.replace(".ihx", ".map")) as lines:
        for line in lines:
            match = re.match(r"\s*[CD]:\s*([0-9A-F]{8})\s+_(\w+)", line)
            if match:
                found[match[2]] = int(match[1], 16)
    return found


def arrivals(octets):
    """Times at which RI was set. One that the simulator has not seen was some 12 cycles before it was cleared again."""
    found, waiting = [], False
    for kind, value, t in octets:
        if kind == "TX":
            break
        if kind == "RI":
            if value or not waiting:
                found.append(t if value else t - 12)
            waiting = value == 1
    return found


def stays(log):
    """How long each interrupt took that watch_interrupt() has noted. An address is passed over when it comes right after
    an event: one that has not been seen to end did so then."""
    found, entered, last = [], None, 0
    for kind, value, t in log:
        if kind == "INT":
            if entered is not None:
                found.append((last if value else t) - entered + ENTRY + RETI)
            entered = t if value else None
        last = t
    return found


class Exchange:
    """What happened between a request and the silence after it; times in machine cycles."""

    def __init__(self, log, answer, busy=()):
        self.answer = answer
        self.arrived = arrivals(log)
        self.fetched = [t for kind, value, t in log if kind == "RI" and value == 0]
        self.written = [t for kind, _, t in log if kind == "TX"]
        self.parity = [value for kind, value, _ in log if kind == "TX"]
        self.driver = [(t, value) for kind, value, t in log if kind == "DE"]
        self.stays = stays([entry for entry in log if not self.written or entry[2] < self.written[0]])
        self.busy = busy  # (t, cycles spent in interrupts since the start)

    @property
    def turn(self):
        """End of the last octet of the request to the first octet of the answer."""
        before = [t for t in self.arrived if t < self.written[0]]
        return self.written[0] - before[-1]

    def waits(self):
        """From each octet's RI to its clearing: longer than an octet, and the next one is lost."""
        return [b - a for a, b in zip(self.arrived, self.fetched)]

    @property
    def begin(self):
        return self.busy[0][0]

    @property
    def end(self):
        return self.busy[-1][0]

    def spent(self, until):
        """In interrupts, from before the request."""
        return next(busy for t, busy in self.busy if t >= until) - self.busy[0][1]

    def left(self):
        """The part not spent in interrupts, from before the request to the silence after it or its answer."""
        (begin, before), (end, after) = self.busy[0], self.busy[-1]
        return 1 - (after - before) / (end - begin)

    def gaps(self, octet_cycles):
        """Between the end of each octet sent and the write of the next."""
        return [b - a - octet_cycles for a, b in zip(self.written, self.written[1:])]


class Chip:
    def __init__(self, image, mhz=12, switches=5, measured=False):
        """measured: the time spent in interrupts is noted, too."""
        self.image, self.symbols = image, symbols(image)
        self.folder = tempfile.mkdtemp(prefix="s51-")
        self.to_chip, self.from_chip = (os.path.join(self.folder, name) for name in ("in", "out"))
        os.mkfifo(self.to_chip)
        os.mkfifo(self.from_chip)
        # both opened for both directions: opening never blocks, and there is no end of file
        self.input = os.open(self.to_chip, os.O_RDWR)
        self.output = os.open(self.from_chip, os.O_RDWR | os.O_NONBLOCK)
        self.process = subprocess.Popen(
            ["s51", "-t", "52", "-X", f"{mhz}M", "-b", "-P", "-S", f"in={self.to_chip},out={self.from_chip}", image],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, bufsize=0)
        self.count, self.breaks, self.text, self.log, self.busy = 0, 0, b"", [], []
        self.ticks = 0  # clocks since reset
        self.stamp = f"expr /d sim_ticks;{BUSY}" if measured else "expr /d sim_ticks"
        self.command("uart0_check_often=1")
        self.command("var odd\nvar heard\nvar up\nvar spoil\nvar every\nodd=0\nheard=0\nup=0\nspoil=0\nevery=0xffffffff")
        # up: this octet has been counted in heard; a driver that clears RI behind its own octets has REN off
        self.watch(f"bits w 0x{RI_BIT:x}", f"heard=heard+(RI|((up^1)&REN));up=RI;RB8=({PARITY})^odd^((heard==spoil)|((heard%every)==0));"
                   f"expr /d 810000+RI;{self.stamp}")
        # what is written while an interrupt is being entered goes unseen: the octet is counted, and the ninth bit supplied
        # again, where SBUF is read
        self.watch(f"sfr r 0x{SBUF:x}", f"heard=heard+(up^1);up=1;RB8=({PARITY})^((heard==spoil)|((heard%every)==0))")
        self.watch(f"sfr w 0x{SBUF:x}", f"expr /d 820000+TB8;{self.stamp}")
        self.command(f"set mem sfr 0x90 0x{~switches & 0x7f | 0x80:x}")

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.input)
        os.close(self.output)
        shutil.rmtree(self.folder)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # ---- console ----

    def command(self, text, seconds=60):
        """Say something to the simulator -> what it answered."""
        self.count += 1
        mark = 770000000 + self.count
        self.process.stdin.write(f"{text}\nexpr /d {mark}\n".encode())
        end, found = time.monotonic() + seconds, f"\n{mark}\n".encode()
        while found not in self.text:
            if not select.select([self.process.stdout], [], [], max(0, end - time.monotonic()))[0]:
                raise Stuck(self.text[-300:].decode(errors="replace"))
            data = os.read(self.process.stdout.fileno(), 65536)
            if not data:
                raise Stuck("s51 has ended")
            self.text += data.replace(b"\0", b"")
        answer, self.text = self.text.split(found, 1)
        return re.sub(r"Simulation started.*\n", "", answer.decode(errors="replace"))

    def value(self, expression):
        return int(re.findall(r"^(-?\d+)$", self.command(f"expr /d {expression}"), re.M)[-1])

    def watch(self, event, script):
        self.command(f"commands {self.break_at(event)} {script};go")

    def watch_driver(self):
        """Not while step() is used. -> number of the breakpoint"""
        self.watch(f"bits w 0x{P3_2_BIT:x}", f"expr /d 830000+{DRIVER};expr /d sim_ticks")
        return self.breaks

    def watch_interrupt(self, handler, returns):
        """Addresses: of what its vector jumps to, and of the reti that it may end with. Not while step() is used."""
        for at, entered in ((handler, 1), *((at, 0) for at in returns)):
            self.watch(f"0x{at:x}", f"expr /d 880000+{entered};expr /d sim_ticks")

    def break_at(self, event):
        """-> the breakpoint's number: they are counted, and not always told."""
        self.breaks += 1
        self.command(f"break {event}")
        return self.breaks

    def counter_at(self, name):
        """Where an FDL counter stands in external RAM, low octet first."""
        return self.symbols["fdl_counters"] + 2 * FDL_COUNTERS.index(name)

    @property
    def cycles(self):
        return self.clocks(self.value("sim_ticks")) // CLOCKS

    def run_to(self, label, seconds=60, times=1):
        """Run until the function label is entered, for the times-th time, or "1 if" something; what happened is in self.log."""
        self.breaks += 1
        self.take_log(self.command(f"break 0x{self.symbols[label]:x} {times}\nrun\ndelete {self.breaks}\n"
                                   f"expr /d 890000;{self.stamp}", seconds))

    def spoil(self, number):
        """The number-th octet from now (1..) comes with wrong parity."""
        self.value(f"spoil=heard+{number}")

    def spoil_every(self, number):
        """So does every number-th one."""
        self.value(f"every={number}")

    def step(self, instructions):
        """Nothing that is watched may happen meanwhile: it would turn the step into a run."""
        self.take_log(self.command(f"step {instructions}\nexpr /d 890000;{self.stamp}"))

    def wait_until(self, cycle):
        """Nearly, by steps: an instruction takes one or two cycles, four at most."""
        while cycle - self.log[-1][2] > 50:
            self.step(int(cycle - self.log[-1][2]) // 2)

    def take_log(self, text):
        """Pair by pair: a time can look like what is noted."""
        for code, value, told in re.findall(r"^(8[0-689])(\d{4})\n(-?\d+)$", text, re.M):
            self.take_note(int(code), int(value), told)

    def take_note(self, code, value, told):
        if code == 80:
            self.busy.append((self.log[-1][2], int(told) / CLOCKS))
        elif code in KINDS:
            self.log.append((KINDS[code], value, self.clocks(told) / CLOCKS))

    def clocks(self, told):
        """-> clocks since reset, from what the simulator tells."""
        self.ticks += ((int(told) - self.ticks + 0x80000000) & 0xFFFFFFFF) - 0x80000000
        return self.ticks

    def times(self):
        """(all, in interrupts) since the start, machine cycles."""
        text = self.command("timer get")
        clocks = {name: int(n) for name, n in re.findall(r'\("(\w+)"\).*\((\d+) clks\)', text)}
        return clocks["time"] / CLOCKS, clocks["isr"] / CLOCKS

    def highest_sp(self):
        """The stack pointer's highest value since the start."""
        return int(re.search(r"Max value of stack pointer= (0x\w+)", self.command("state"))[1], 16)

    # ---- the line ----

    def wait_for_rate(self, n):
        """Until the baud search has just come to Timer 2's divisor n, and the line has been silent for T_SYN since: the end
        of that may have been before the main loop knows the rate, and is not told again."""
        self.run_to("dp_test01_poll", times=f"1 if RCAP2L=={256 - n}")
        self.wait_until(self.cycles + 2 * T_SYN * n * 8 // 3)
        self.watch_driver()

    def ask(self, request, idle=40):
        """Send request idle instructions from now, run until T_SYN of silence after it and its answer."""
        self.step(idle)
        self.log, self.busy = [], self.busy[-1:]
        os.write(self.input, request)
        self.run_to("phy_syn_ind_isr")
        try:
            answer = os.read(self.output, 4096)
        except BlockingIOError:
            answer = b""
        return Exchange(self.log, answer, self.busy)
