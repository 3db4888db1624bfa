#!/usr/bin/env python3
"""The remote modules' images for the 87C51FB in s51, with the modelled 8273 at its address, polled by the master
station over a pseudo terminal. Everything on the simulated side is timed in machine cycles.

s51 runs in slices: up to the next change of the chip's status or interrupt lines, or to the next access of the
program to a register of the chip, whichever is first (console of s51: facts, co-simulation)."""
import ctypes
import json
import os
import pty
import re
import select
import socket
import subprocess
import sys
import tempfile
import threading
import time
import tty

import scripted
from stack51 import measured_and_computed

BIN = os.environ.get("FIELDLING_BIN", "build/posix")
CLOCKS_PER_BIT = 12_000_000 / 7200
WRITES, READS = (0, 1, 2, 4), (1, 2, 3, 8)  # of the chip; the status is put into the memory cell beforehand
CHIP, PROMPT = 0x8000, b"#RDY#"
SLICE = 256  # bit times at most
STARTED = 400  # bit times: the module is in its main loop and has taken samples
highest_sp = {}  # image: of the stack pointer, in all its runs


def chip_library():
    path = "build/test/chip51.so"
    os.makedirs("build/test", exist_ok=True)
    subprocess.run(["gcc", "-std=c99", "-O2", "-shared", "-fPIC", "-I.", "host_tests/chip51.c", "sim/i8273.c",
                    "sim/i8273_line.c", "sim/hdlc_bits.c", "-o", path], check=True)
    return ctypes.CDLL(path)


class S51:
    """s51 on its TCP console. A second connection that always has newlines waiting keeps it from sleeping 100 ms at
    every stop."""

    def __init__(self, image):
        for _ in range(5):
            with socket.socket() as s:
                s.bind(("127.0.0.1", 0))
                port = s.getsockname()[1]
            command = ["s51", "-t", "C52", "-X", "12M", "-b", "-p", PROMPT.decode(), "-Z", str(port), image]
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL)
            self.socket = self._connect(port)
            if self.socket:
                break
            self.process.kill()
            self.process.wait()
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.heard = b""
        self._reply(PROMPT)
        self.flood = self._connect(port)
        threading.Thread(target=self._drain, daemon=True).start()
        threading.Thread(target=self._pour, daemon=True).start()

    def _connect(self, port):
        for _ in range(100):
            try:
                return socket.create_connection(("127.0.0.1", port))
            except OSError:
                if self.process.poll() is not None:
                    return None
                time.sleep(0.05)
        return None

    def _drain(self):
        try:
            while self.flood.recv(65536):
                pass
        except OSError:
            pass

    def _pour(self):
        try:
            while True:
                self.flood.sendall(b"\n" * 512)
        except OSError:
            pass

    def _reply(self, until):
        while until not in self.heard or PROMPT not in self.heard[self.heard.index(until):]:
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)
            some = self.socket.recv(65536)
            if not some:
                raise AssertionError("s51 has ended")
            self.heard += some
        end = self.heard.index(PROMPT, self.heard.index(until)) + len(PROMPT)
        text, self.heard = self.heard[:end], self.heard[end:]
        return text.decode("latin1")

    def ask(self, line):
        self.socket.sendall(line.encode() + b"\n")
        return self._reply(PROMPT)

    def cell(self, memory, address):
        text = self.ask(f"dump {memory} {address:#x} {address:#x}")
        return int(re.search(r"(?:0b[01]+ 0x|0x[0-9a-f]+\s+)([0-9a-f]{2})\b", text).group(1), 16)

    def run(self, before, clocks):
        """-> clocks that passed, what stopped it: None (about so many clocks), ("read"|"write", address), "fetch\""""
        self.socket.sendall((";".join([*before, f"step {max(1, int(clocks) // 24)}"]) + "\n").encode())
        text = self._reply(b"Stop at")
        passed = int(re.search(r"(?:stepped|Simulated) (\d+) ticks", text).group(1))
        event = re.search(r"Event `(\w+)' at \w+\[0x([0-9a-f]+)\]", text)
        if event:
            return passed, (event.group(1), int(event.group(2), 16))
        return passed, "fetch" if "Breakpoint" in text else None

    def end(self):
        self.process.kill()
        self.process.wait()
        self.socket.close()
        self.flood.close()


class Board:
    """One module: the program in s51, its chip, the line as a list of bits to come and a list of bits it drove."""

    def __init__(self, image, address):
        self.image = image
        self.chip = chip_library()
        self.chip.chip_begin()
        self.s51 = S51(image)
        for offset in WRITES:
            self.s51.ask(f"break xram w {CHIP + offset:#x}")
        for offset in READS:
            self.s51.ask(f"break xram r {CHIP + offset:#x}")
        # address switches; the converter says half of the full scale, as the reference input must be
        self.before = [f"expr pin1={~address & 0xFF:#x}", "set mem xram 0x8021 0x08", "set mem xram 0x8022 0x00"]
        self.clocks = 0  # of the program
        self.bits = 0    # of the line
        self.status = self.pins = None
        self.to_come, self.drove, self.driving = [], [], False
        self.began = self.ended = None  # bit times: first driven bit; end of what was on the line before
        self.accesses = 0
        self._refresh()
        self.bits_pass(30)

    def _refresh(self):
        status = self.chip.chip_read(0)
        active = self.chip.chip_interrupts()
        if status != self.status:
            self.status = status
            self.before.append(f"set mem xram {CHIP:#x} {status:#x}")
        if active != self.pins:
            self.before.append(f"expr pin3={0xFF & ~(active << 2):#x}")
            # s51 leaves IE0, IE1 set when a level has gone: on silicon they follow the pin
            if self.pins is not None and self.pins & ~active & 1:
                self.before.append("set mem bits 0x89 0")
            if self.pins is not None and self.pins & ~active & 2:
                self.before.append("set mem bits 0x8b 0")
            self.pins = active

    def _one_bit(self):
        heard = bool(self.to_come)
        bit = self.chip.chip_bit(self.to_come.pop(0) if heard else 1)
        self.bits += 1
        self.driving = bit != 2
        if heard:
            self.ended = self.bits
        if bit != 2:
            if not self.drove:
                self.began = self.bits - 1
            self.drove.append(bit)

    def _catch_up(self):
        while (self.bits + 1) * CLOCKS_PER_BIT <= self.clocks:
            self._one_bit()

    def _access(self, kind, address):
        self.accesses += 1
        if kind == "write":
            self.chip.chip_write(address - CHIP, self.s51.cell("xram", address))
            if address == CHIP:
                self.status = None  # the cell now holds the command
        else:  # MOVX has run: the accumulator gets what the chip says
            self.before.append(f"set mem sfr 0xe0 {self.chip.chip_read(address - CHIP):#x}")

    def slice(self, limit):
        """Run to the next event, at most `limit` bit times."""
        levels = (self.to_come + [1] * SLICE)[:max(1, min(limit, SLICE))]
        quiet = self.chip.chip_quiet(bytes(levels), len(levels))
        wanted = (self.bits + quiet) * CLOCKS_PER_BIT - self.clocks
        before, self.before = self.before, []
        passed, stopped = self.s51.run(before, wanted)
        self.clocks += passed
        self._catch_up()
        if isinstance(stopped, tuple):
            self._access(*stopped)
        self._refresh()
        return stopped

    def bits_pass(self, n):
        end = self.bits + n
        while self.bits < end:
            self.slice(end - self.bits)

    def exchange(self, bits, patience=1000):
        """bits on the line, then wait for the end of an answer -> bits driven"""
        self.to_come, self.drove = list(bits), []
        end = self.bits + len(bits) + patience
        while self.driving or (self.bits < end and not self.drove):
            self.slice(8 if self.drove else end - self.bits)
        return self.drove

    def end(self):
        state = self.s51.ask("state")
        sp = int(re.search(r"Max value of stack pointer= (0x\w+)", state).group(1), 16)
        highest_sp[self.image] = max(sp, highest_sp.get(self.image, 0))
        self.s51.end()


def image(kind):
    return f"build/87c51fb_hdlc/module-{kind}.ihx"


# ---- bits, by the standard, once more (facts 2.5) ------------------------------------------------------------

def frame_bits(octets):
    crc = 0xFFFF
    for octet in octets:
        crc ^= octet
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    bits, ones, flag = [], 0, [0, 1, 1, 1, 1, 1, 1, 0]
    for octet in bytes(octets) + (crc ^ 0xFFFF).to_bytes(2, "little"):
        for i in range(8):
            bit = octet >> i & 1
            bits.append(bit)
            ones = ones + 1 if bit else 0
            if ones == 5:
                bits.append(0)
                ones = 0
    return flag + bits + flag


def literal(board, question, answer):
    drove = board.exchange(frame_bits(bytes.fromhex(question)))
    expected = frame_bits(bytes.fromhex(answer))
    assert drove[:len(expected)] == expected, (question, answer, drove)


# ---- tests ---------------------------------------------------------------------------------------------------

def test_document_frames_and_a_connection():
    """Octets of facts 2.6; inputs are cells of external RAM."""
    board = Board(image("di"), 5)
    try:
        board.before += ["set mem xram 0x8012 0x08", "set mem xram 0x8013 0x00"]
        board.bits_pass(STARTED)
        literal(board, "05080103", "0509010331")
        literal(board, "05080104", "0509010430")
        literal(board, "0593", "0573")
        literal(board, "05100103", "0530010331")
        literal(board, "0531", "0531")
        literal(board, "0553", "0573")
        assert not board.exchange(frame_bits(bytes.fromhex("0693")), 200), "another station's frame was answered"
    finally:
        board.end()


def isr_cycles(board, vector, n):
    """Machine cycles from the vector to the return, n times, while polls go on."""
    found = []
    board.s51.ask(f"break {vector:#x}")
    question = frame_bits(bytes.fromhex("05080103"))
    board.to_come = list(question)
    patience = board.bits + 40 * n * (len(question) + 250)
    while len(found) < n:
        assert board.bits < patience, f"no interrupt at {vector:#x}"
        if not board.to_come and board.bits > (board.ended or 0) + 250:
            board.to_come, board.drove = list(question), []
        if board.slice(300) != "fetch":
            continue
        start = board.clocks
        sp = board.s51.cell("sfr", 0x81)
        back = board.s51.cell("iram", sp) << 8 | board.s51.cell("iram", sp - 1)
        board.s51.ask(f"tbreak {back:#x}")
        # where a slice of time ends just there, the simulator takes the breakpoint for seen
        while board.slice(300) != "fetch" and int(re.search(r"0x\w+", board.s51.ask("pc"))[0], 16) != back:
            pass
        board.s51.ask(f"clear {back:#x}")
        found.append((board.clocks - start) // 12)
    board.s51.ask(f"clear {vector:#x}")
    return found


def budget():
    with open("boards/87c51fb_hdlc/budget.txt", encoding="ascii") as f:
        rows = [line.split("#")[0].split() for line in f]
    return {row[0]: int(row[1]) for row in rows if len(row) == 2}


def figures(kind):
    """-> {name of the budget: measured}. The shortest interrupts are those of octets, the longest those of results."""
    board = Board(image(kind), 5)
    try:
        turns = []
        board.bits_pass(STARTED)
        for question in ("05080103", "0593", "05100103", "0531", "0553"):
            drove = board.exchange(frame_bits(bytes.fromhex(question)))
            assert drove, question
            turns.append(board.began - board.ended)
        rx, tx, timer = (sorted(isr_cycles(board, vector, 24)) for vector in (0x0003, 0x0013, 0x000B))
    finally:
        board.end()
    return {"rx_octet_cycles": rx[0], "rx_interrupt_cycles": rx[-1], "tx_octet_cycles": tx[0],
            "tx_interrupt_cycles": tx[-1], "timer_interrupt_cycles": timer[-1], "turn_round_bits": max(turns)}


def test_interrupts_and_turn_round_are_within_the_budget():
    limits = budget()
    for kind in ("di", "ai"):
        for name, value in figures(kind).items():
            print(f"  module-{kind}: {name} = {value}, budget {limits[name]}")
            assert 0 < value <= limits[name], (kind, name, value, limits[name])


def serve(board, fd, stop):
    """The module's end of a pseudo terminal: eight bits an octet."""
    while not stop():
        if select.select([fd], [], [], 0)[0]:
            octets = os.read(fd, 1024)
            drove = board.exchange([octet >> i & 1 for octet in octets for i in range(8)], 700)
            if drove:
                drove += [1] * (-len(drove) % 8)
                octets = [drove[k:k + 8] for k in range(0, len(drove), 8)]
                os.write(fd, bytes(sum(bit << i for i, bit in enumerate(octet)) for octet in octets))
        else:
            board.bits_pass(72)


def with_master(kind, module, commands):
    """The image polled by fieldling-hdlc-master -> its events."""
    board = Board(image(kind), 7)
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    try:
        with tempfile.NamedTemporaryFile("w", suffix=".conf") as conf:
            conf.write(f"timeout 8000\nmodule m 7 {kind} {module}\n")
            conf.flush()
            command = [os.path.join(BIN, "fieldling-hdlc-master"), "--line", os.ttyname(theirs), "--config", conf.name,
                       "--batch", "90", "--json"]
            master = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            master.stdin.write(commands + "quit\n")
            master.stdin.close()
            try:
                serve(board, ours, lambda: master.poll() is not None)
            finally:
                master.kill()
            text = master.stdout.read()
            master.wait()
        return [json.loads(line) for line in text.splitlines()], board
    finally:
        board.end()
        os.close(ours)
        os.close(theirs)


def outcome(events, event, **wanted):
    return [e for e in events if e["event"] == event and all(e.get(k) == v for k, v in wanted.items())]


def test_the_master_station_polls_di_on_the_chip():
    events, _ = with_master("di", "2000 channels 0-1", "get m 0\nget m 16\nsamples m 1\n")
    assert outcome(events, "data", channel=0, outcome="done"), events
    assert outcome(events, "data", channel=16, outcome="refused", reason="channel"), events
    assert outcome(events, "samples", channel=1, outcome="done")[0]["count"] > 3, events


def test_the_master_station_controls_do_on_the_chip():
    events, _ = with_master("do", "0", "set m 9 1\nset m 16 1\ndiag m\n")
    assert outcome(events, "control", channel=9, outcome="done", value=1), events
    assert outcome(events, "control", channel=16, outcome="refused"), events
    assert outcome(events, "diagnosis", page=0, type=2), events
    assert outcome(events, "diagnosis", page=1, executed=1, crc=0, restarts=0), events


def test_the_master_station_polls_ai_on_the_chip():
    events, _ = with_master("ai", "0", "get m 6\nget m 7\n")
    assert outcome(events, "data", channel=6), events
    assert outcome(events, "data", channel=7, outcome="refused", reason="channel"), events


def test_the_master_station_controls_ao_on_the_chip():
    events, _ = with_master("ao", "0", "set m 6 4095\nset m 1 4096\n")
    assert outcome(events, "control", channel=6, outcome="done", value=4095), events
    assert outcome(events, "control", channel=1, outcome="refused", reason="value"), events


def test_no_stack_was_deeper_than_the_calls_allow():
    assert highest_sp, "no image has run"
    for name, sp in sorted(highest_sp.items()):
        deepest, worst = measured_and_computed(name, sp)
        print(f"  {name}: stack {deepest} octets, by the calls {worst}")
        assert 10 < deepest <= worst, (name, deepest, worst)


if __name__ == "__main__":
    if sys.argv[1:] == ["--figures"]:
        print("HDLC remote modules on the 87C51FB at 12 MHz, 7200 bit/s (an octet: 1111 cycles, a bit: 139); budget:")
        for module in ("di", "ai"):
            print(f"  module-{module}:", ", ".join(f"{k} {v} ({budget()[k]})" for k, v in figures(module).items()))
        sys.exit(0)
    sys.exit(scripted.run(globals(), "host_tests/hdlc_chip.py"))
