"""A board's image in QEMU with time counted in instructions (-icount), fed octet by octet while it stands still.

The machine is stopped, by QEMU's gdb stub, at the instruction at which the main loop goes to sleep; the octet is put into its
UART, and only then it goes on. So what runs, and when, depends on nothing but the image: no clock of the host, no luck. The
instructions are listed by -d exec with one instruction a block.
"""
import json
import os
import pty
import re
import select
import socket
import subprocess
import tempfile
import time
import tty
from bisect import bisect_right

from machine import image_path, qemu

SLEEP = {"com86": "sti", "lm3s6965evb": "wfi"}  # with which hal_idle() goes to sleep
RECEIVED = {"com86": ("i /1xb 0x2fd", 0x01), "lm3s6965evb": ("xp /1xw 0x4000d018", 0x10)}  # LSR.DR; not FR.RXFE
CLOCK = {  # of _tick(): general-purpose timer 1, periodic, every 1000 clocks
    "com86": [], "lm3s6965evb": [word for register, value in ((0x04, 2), (0x28, 1000), (0x0C, 1))
                                 for word in ("-device", f"loader,addr={0x40031000 + register:#x},data={value},data-len=4")]}
EMPTY = {"com86": 0, "lm3s6965evb": 0x10}
PATIENCE = 10.0


def tool(board, name):
    return {"com86": "", "rv32virt": "riscv64-unknown-elf-"}.get(board, "arm-none-eabi-") + name


def output_of(*command):
    return subprocess.run(command, text=True, check=True, stdout=subprocess.PIPE).stdout


class Symbols:
    """Symbols(...)(pc) -> name of the function; .first[name] is its first address."""

    def __init__(self, board, image):
        thumb = 0 if board == "com86" else 1
        rows = map(str.split, output_of(tool(board, "nm"), f"build/{board}/{image}.elf").splitlines())
        found = sorted((int(a, 16) & ~thumb, name) for a, kind, name in rows if kind in "tT")
        self.starts = [a for a, _ in found]
        self.names = [name for _, name in found]
        self.first = dict((name, a) for a, name in found)

    def __call__(self, pc):
        return self.names[bisect_right(self.starts, pc) - 1]


class Monitor:
    """QEMU's own monitor (QMP)."""

    def __init__(self, path):
        self.socket = connected(path)
        self.file = self.socket.makefile("rw", encoding="utf-8")
        self.file.readline()
        self.ask("qmp_capabilities")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()
        self.socket.close()

    def ask(self, command, **arguments):
        self.file.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
        self.file.flush()
        while True:
            answer = json.loads(self.file.readline())
            if "error" in answer:
                raise AssertionError(f"{command}: {answer['error']}")
            if "return" in answer:
                return answer["return"]

    def human(self, line):
        return self.ask("human-monitor-command", **{"command-line": line})

    def memory(self, start, end, file):
        self.ask("pmemsave", val=start, size=end - start, filename=file)
        with open(file, "rb") as saved:
            return saved.read()


def connected(path):
    end = time.monotonic() + PATIENCE
    while True:
        s = socket.socket(socket.AF_UNIX)
        s.settimeout(PATIENCE)
        try:
            s.connect(path)
            return s
        except OSError:
            s.close()
            if time.monotonic() > end:
                raise
            time.sleep(0.02)


class Gdb:
    """What is needed of gdb's remote protocol: one breakpoint, and going on to it."""

    def __init__(self, path):
        self.socket = connected(path)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def _ask(self, packet):
        self.socket.sendall(b"$%s#%02x" % (packet, sum(packet) % 256))
        got = b""
        while not re.search(rb"\$[^#]*#..", got):
            more = self.socket.recv(4096)
            if not more:
                raise AssertionError("QEMU has gone")
            got += more
        self.socket.sendall(b"+")
        return re.search(rb"\$([^#]*)#", got).group(1)

    def run_to(self, address):
        place = b"0,%x,2" % address
        assert self._ask(b"Z" + place) == b"OK"
        stopped = self._ask(b"c")
        assert stopped.startswith(b"T05"), stopped
        assert self._ask(b"z" + place) == b"OK"


class Counted:
    """with Counted("com86", "fieldling-dp") as m: m.sleep(60); m.hear(b"..."); then for name, is_first in m.trace(): ..."""

    def __init__(self, board, image):
        self.board = board
        self.symbol = Symbols(board, image)
        self.idle = self.symbol.first["hal_idle"]
        code = output_of(tool(board, "objdump"), "-d", "--disassemble=hal_idle", f"build/{board}/{image}.elf")
        self.asleep = int(re.search(rf"^\s*([0-9a-f]+):.*\t{SLEEP[board]}\b", code, re.M).group(1), 16)
        self.folder = tempfile.TemporaryDirectory(prefix="fieldling-")
        self.log = f"{self.folder.name}/trace"
        self.line, theirs = pty.openpty()
        tty.setraw(theirs)
        sockets = {name: f"{self.folder.name}/{name}" for name in ("qmp", "gdb")}
        self.process = subprocess.Popen(
            qemu(board, image_path(board, image), console="null,id=console",
                 line=f"serial,id=line,path={os.ttyname(theirs)}", events=self.log,
                 more=["-icount", "shift=5,sleep=off", "-rtc", "base=2000-01-01,clock=vm", "-singlestep", "-S", *CLOCK[board],
                       "-qmp", f"unix:{sockets['qmp']},server=on,wait=off",
                       "-gdb", f"unix:{sockets['gdb']},server=on,wait=off"]),
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.theirs = theirs
        self.monitor = Monitor(sockets["qmp"])
        self.gdb = Gdb(sockets["gdb"])
        self._tick()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.gdb.__exit__()
        self.monitor.__exit__()
        self.process.kill()
        self.process.wait()
        os.close(self.line)
        os.close(self.theirs)
        self.folder.cleanup()

    def _tick(self):
        """A clock that nobody listens to. When QEMU stops at a breakpoint it takes the processor for asleep and lets time
        jump to the next event: so there must always be one soon."""
        if self.board == "com86":  # the real-time clock, 8192 Hz; its interrupt is masked
            for index, value in ((0x0A, 0x23), (0x0B, 0x42)):
                self.monitor.human(f"o /b 0x70 {index:#x}")
                self.monitor.human(f"o /b 0x71 {value:#x}")

    def sleep(self, times=1):
        """Go on until the main loop has gone to sleep so many times."""
        for _ in range(times):
            self.gdb.run_to(self.idle)
            self.gdb.run_to(self.asleep)

    def _has_received(self):
        question, bit = RECEIVED[self.board]
        value = int(self.monitor.human(question).split()[-1], 16)
        return (value & bit) != EMPTY[self.board]

    def hear(self, octets):
        """An octet each time the main loop goes to sleep. -> what has been answered before"""
        answer = b""
        for octet in octets:
            os.write(self.line, bytes([octet]))
            end = time.monotonic() + PATIENCE
            while not self._has_received():
                assert time.monotonic() < end, "the octet did not come to the UART"
            self.sleep()
        while select.select([self.line], [], [], 0)[0]:
            answer += os.read(self.line, 4096)
        return answer

    def listing(self, on):
        self.monitor.human("log exec,nochain" if on else "log none")

    def trace(self):
        """-> (function, is this its first instruction) of each instruction listed"""
        first = set(self.symbol.starts)
        with open(self.log, encoding="ascii", errors="replace") as file:
            for line in file:
                found = re.search(r"Trace 0: \S+ \[[0-9a-f]+/([0-9a-f]+)/", line)
                if found:
                    pc = int(found.group(1), 16)
                    yield self.symbol(pc), pc in first
