"""The asking end of a pseudo terminal, octet by octet: what a master does, without one. Every wait is bounded."""
import os
import select
import termios
import time
import tty

from station import PATIENCE

SLOT = 0.5  # seconds to wait for an answer before asking again; the machine may be busy
TRIES = 6


def octets(text):
    return bytes.fromhex(text)


class RawMaster:
    """with RawMaster(path) as m: m.ask("10 08 02 49 53 16", "10 02 08 00 0A 16")"""

    def __init__(self, path):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.fd, termios.TCSANOW)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.fd)

    def say(self, text):
        os.write(self.fd, octets(text))

    def hear(self, seconds=SLOT, n=1):
        """What comes within so long, at least n octets; b"" if nothing does."""
        heard, end = b"", time.monotonic() + seconds
        while len(heard) < n and select.select([self.fd], [], [], max(0, end - time.monotonic()))[0]:
            try:
                more = os.read(self.fd, 4096)
            except BlockingIOError:  # what was there has been dropped meanwhile: it was for the master before
                continue
            if not more:
                raise AssertionError("the line was hung up")
            heard += more
        return heard

    def ask(self, request, answer, tries=TRIES):
        """Like a master: the request is sent again when no answer comes."""
        expected = octets(answer)
        for _ in range(tries):
            self.say(request)
            heard = self.hear(n=len(expected))
            if heard:
                if heard != expected:
                    raise AssertionError(f"{request}: expected {answer}, was {heard.hex(' ')}")
                return
        raise AssertionError(f"{request}: no answer in {tries} tries")

    def no_answer(self, request, seconds=0.2):
        self.say(request)
        heard = self.hear(seconds)
        if heard:
            raise AssertionError(f"{request}: expected silence, was {heard.hex(' ')}")

    def wait_for_answer(self, request, answer):
        """Until the station gives this very answer (another one may come first)."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.say(request)
            if self.hear() == octets(answer):
                return
            time.sleep(0.01)
        raise AssertionError(f"{request}: {answer} did not come in {PATIENCE:.0f} s")


# Slave 8, master 2, DP-TEST01 with ident 1234; formats and FCS: EN 50170-2 part 4, 4.7; services: spec A6.
STATUS = "10 08 02 49 53 16", "10 02 08 00 0A 16"
DIAG_FIRST = "68 05 05 68 88 82 6D 3C 3E F1 16"
DIAG_NEW = "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16"  # not ready, Prm_Req, no master
SET_PRM = "68 0C 0C 68 88 82 5D 3D 3E 80 00 00 0B 12 34 00 B3 16"  # lock, no watchdog
CHK_CFG = "68 09 09 68 88 82 7D 3E 3E 10 20 10 20 63 16"
DIAG_AGAIN = "68 05 05 68 88 82 5D 3C 3E E1 16"
DIAG_READY = "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16"


def bring_up(master):
    """From power-up to data exchange; the next request must have FCB = 1."""
    master.ask(DIAG_FIRST, DIAG_NEW)
    master.ask(SET_PRM, "E5")
    master.ask(CHK_CFG, "E5")
    master.wait_for_answer(DIAG_AGAIN, DIAG_READY)


class Exchange:
    """Data_Exchange after data exchange: outputs out of one number, FCB alternating."""

    def __init__(self, master):
        self.master, self.fcb = master, True

    def __call__(self, first, second, inputs="1F 00"):
        body = bytes([8, 2, 0x7D if self.fcb else 0x5D, first, second])
        request = bytes([0x68, 5, 5, 0x68]) + body + bytes([sum(body) & 0xFF, 0x16])
        given = octets(inputs)
        answer = bytes([0x68, 5, 5, 0x68, 2, 8, 8]) + given + bytes([18 + sum(given) & 0xFF, 0x16])
        self.master.ask(request.hex(), answer.hex())
        self.fcb = not self.fcb
