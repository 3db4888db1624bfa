"""An image in the simulator s51 as a station on a pseudo terminal: any master can talk to it, in the host's time.

    with ChipOnPty(image, rate_n) as chip:
        chip.start()    chip.pty is the line

The simulation runs freely, a few times as fast as the part, slower and in bursts on a busy machine. A pseudo terminal
has no bit times; what a line would do is done by a relay, generously (our choice):
  - a request is kept back until the simulated line has been silent for long: T_SYN is there however slow the simulation;
  - an answer is handed over in one piece, when the driver goes off: no gap between octets that the chip did not make.
What the simulator writes down while it runs, chip.py has the list, is kept for the time after the end.
"""
import collections
import os
import re
import select
import threading
import time
import tty

import chip as s51

OCTET = 0.0023  # seconds: twice what an octet takes at 9600 bit/s
PAUSE = 0.03    # seconds: eight times T_SYN at 9600 bit/s
PIECE = 0.5      # seconds without an octet end an answer, if nobody has seen the driver go off
LOOK = 0.004     # seconds between two looks for that
OFF = b"\n830000\n"  # the simulator's note of it
BREAK = 2600    # machine cycles between the ends of two octets of different telegrams: two octets at 9600 bit/s and more

FOUND = bytes.fromhex("10 7D 02 49 C8 16")  # FDL status of station 125: a telegram to end the baud search with
COUNT = 870000   # in the simulator's notes: a counter's low octet

Request = collections.namedtuple("Request", "octets answered")


class ChipOnPty(s51.Chip):
    def __init__(self, image, rate_n, **options):
        """Up to the moment the baud search has found the rate, Timer 2's divisor rate_n; then it runs."""
        super().__init__(image, **options)
        self.ends = os.pipe()
        self.noted, self.octets_sent, self.offs = bytearray(), bytearray(), 0
        self.near, self.far = os.openpty()  # far stays open here: a master may come and go
        tty.setraw(self.near)
        self.pty = os.ttyname(self.far)
        self.threads = [threading.Thread(target=work, daemon=True) for work in (self._relay, self._note)]
        try:
            self.wait_for_rate(rate_n)
            self.ask(FOUND)
        except BaseException:
            self.close()
            raise

    def start(self):
        """Run until the end; what is to be said to the simulator must have been said before."""
        self.process.stdin.write(b"run\n")
        for thread in self.threads:
            thread.start()

    def close(self):
        os.close(self.ends[1])
        self.process.kill()
        for thread in self.threads:
            if thread.is_alive():
                thread.join()
        for end in (self.near, self.far, self.ends[0]):
            os.close(end)
        super().close()

    def _relay(self):
        """Until close(): each request after a pause, each answer when it has ended."""
        requests, answer, free_at, ended_at, offs = collections.deque(), b"", 0.0, 0.0, 0
        while True:
            now = time.monotonic()
            if answer and (self.offs > offs or now >= ended_at):
                answer += self._sent()
                os.write(self.near, answer)
                answer, free_at, offs = b"", now + PAUSE, self.offs
            if requests and not answer and now >= free_at:
                request = requests.popleft()
                os.write(self.input, request)
                free_at = now + len(request) * OCTET + PAUSE
            wait = LOOK if answer else max(0, free_at - now) if requests else None
            ready = select.select([self.output, self.near, self.ends[0]], [], [], wait)[0]
            if self.ends[0] in ready:
                return
            if self.output in ready:
                answer, ended_at = answer + self._sent(), time.monotonic() + PIECE
            if self.near in ready:
                requests.append(os.read(self.near, 4096))

    def _sent(self):
        """-> what the chip has sent and nobody has read."""
        try:
            octets = os.read(self.output, 4096)
        except BlockingIOError:
            return b""
        self.octets_sent += octets
        return octets

    def _note(self):
        seen = 0
        while data := os.read(self.process.stdout.fileno(), 65536):
            self.noted += data.replace(b"\0", b"")
            found = self.noted.count(OFF, seen)
            seen = max(seen, len(self.noted) - len(OFF) + 1)
            self.offs += found

    def note(self, counter):
        """Each value of an FDL counter will be written down. Before start()."""
        cell = f"0x{self.counter_at(counter):x}"
        self.watch(f"xram w {cell}", f"expr /d {COUNT}+xram[{cell}]")

    # ---- when it has ended ----

    def noted_counts(self):
        """-> the values that note()'s counter has taken."""
        return [int(n) for n in re.findall(rf"^{COUNT // 1000}(\d{{3}})$", self.noted.decode(errors="replace"), re.M)]

    def read_log(self):
        self.log = []
        self.take_log(self.noted.decode(errors="replace"))

    def parity_sent(self):
        """-> the ninth bit of each octet the chip has sent."""
        return [value for kind, value, _ in self.log if kind == "TX"]

    def requests(self):
        """-> each telegram to the chip: its octets, and those sent before the next one."""
        found, last = [], -BREAK
        for kind, value, t in self.log:
            if kind == "RI" and value == 1:
                if t - last >= BREAK:
                    found.append([0, 0])
                found[-1][0] += 1
                last = t
            elif kind == "TX" and found:
                found[-1][1] += 1
        return [Request(*pair) for pair in found]
