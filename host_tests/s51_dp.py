#!/usr/bin/env python3
"""DP-TEST01 on the 87C51FB, in the simulator s51: answers, their timing to the machine cycle, parity, the driver.

usage: s51_dp.py [--figures]     the table of figures alone: s51_dp.py says what is in it

Octet for octet of a request, machine cycles in interrupts of every kind: from the silence before it to its last octet (in),
and to the first one of the answer or to the silence after it (out); the longest that the serial port's interrupt lasts,
entered as the real part does it; the longest that RI waits to be cleared: an octet's time, and the next octet would be lost.
Gap: from TI to the next octet; TI comes a bit earlier on the real part, and what is below zero then is none. Main loop: its
part of the time from the request to the silence after it or its answer.

Expected telegrams are worked out by hand: address 5, master 2, EN 50170-2 part 8; FCS is the sum modulo 256.
A request that gets no answer is repeated, as a master does (max_retry), but in the table no repetition is needed.
"""
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from asm51 import Image
from stack51 import measured_and_computed

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
import chip as s51  # noqa: E402

IMAGE = str(ROOT / "build" / "87c51fb" / "fieldling-dp.ihx")
STATUS = "10 05 02 49 50 16"
DIAG_FIRST = "68 05 05 68 85 82 6D 3C 3E EE 16"
DIAG = "68 05 05 68 85 82 5D 3C 3E DE 16"
SET_PRM = "68 0C 0C 68 85 82 5D 3D 3E 80 01 01 0B 12 34 00 B2 16"
CHK_CFG = "68 09 09 68 85 82 7D 3E 3E 10 20 10 20 60 16"
DIAG_7D = "68 05 05 68 85 82 7D 3C 3E FE 16"
NOT_YET = "68 0B 0B 68 82 85 08 3E 3C 02 04 00 FF 12 34 D4 16"  # acknowledged, but the main loop has not looked at it yet
DX_7D = "68 05 05 68 05 02 7D 11 22 B7 16"
DX_5D = "68 05 05 68 05 02 5D 33 44 DB 16"
FOREIGN = "68 05 05 68 84 82 6D 3C 3E ED 16"
# the process inputs of the simulated board read back its outputs; NEW: answered with data, to another header than before
CYCLIC, NEW, AGAIN = "T_SDR", "T_SDR_new", "T_SDR_again"
SCENE = [
    ("FDL status", STATUS, "10 02 05 00 07 16", CYCLIC),
    ("Slave_Diag, the first", DIAG_FIRST, "68 0B 0B 68 82 85 08 3E 3C 02 05 00 FF 12 34 D5 16", NEW),
    ("Set_Prm", SET_PRM, "E5", CYCLIC),
    ("Chk_Cfg", CHK_CFG, "E5", CYCLIC),
    ("Slave_Diag, the first", DIAG, "68 0B 0B 68 82 85 08 3E 3C 00 04 00 02 12 34 D5 16", NEW),
    ("Slave_Diag", DIAG_7D, "68 0B 0B 68 82 85 08 3E 3C 00 04 00 02 12 34 D5 16", AGAIN),
    ("Data_Exchange, first", DX_5D, "68 05 05 68 02 05 08 00 00 0F 16", NEW),
    ("Data_Exchange", DX_7D, "68 05 05 68 02 05 08 33 44 86 16", AGAIN),
]
RATES = {39: 9600, 4: 93750, 2: 187500}  # by the divisor of Timer 2 at 12 MHz
RETRIES = 3
SERIAL = 0x23  # its vector
PHASES = 24
# between two requests [instructions]: the main loop's turn, so that the next answer shows what the last request did
MASTER_PAUSE = 24000

BUDGET = {(int(rate), what): float(limit) for rate, what, limit in
          (line.split() for line in (ROOT / "boards" / "87c51fb" / "timing.txt").read_text().splitlines()
           if line and not line.startswith("#"))}
# T_bit, as the GSD file promises
MAX_T_SDR = {int(rate): int(most) for rate, most in
             re.findall(r"R\([\d.]+, (\d+), (\d+)\)", (ROOT / "boards" / "87c51fb" / "dp_rates.h").read_text())}
REAL_BITS, REAL_CYCLES = 0.5, 4  # later on the real part, at most: a start bit waits up to a bit, RI is half a bit earlier;
                                 # two interrupts are entered, two cycles each

HEADING = """\
                                    cycles an octet   longest   RI     T_SDR [T_bit]   gap [cycles]   main
 bit/s  request              octets   in    out   interrupt  waits    s51   real      s51   real    loop"""

results = []


def check(name, good, detail=""):
    results.append(bool(good))
    if not good:
        print(f"{name}:FAIL: {detail}")


def octets(text):
    return bytes.fromhex(text)


def sd2(body):
    """A telegram of variable length around DA SA FC and data, in hexadecimal."""
    data = octets(body)
    return bytes([0x68, len(data), len(data), 0x68]) + data + bytes([sum(data) & 0xFF, 0x16])


def parity(octet):
    return bin(octet).count("1") & 1


class Bench:
    """The chip at one rate, and the rows of its table."""

    def __init__(self, chip, n):
        self.chip, self.rate, self.rows = chip, RATES[n], []
        self.bit = n * 8 / 3  # machine cycles
        image = Image(IMAGE)
        chip.wait_for_rate(n)
        chip.watch_interrupt(image.code[image.target(SERIAL)], image.returns(SERIAL))

    def check(self, name, good, detail=""):
        check(f"{name} at {self.rate}", good, detail)

    def most(self, name, what, value):
        self.check(f"{name}: {what}", value <= BUDGET[self.rate, what], f"{value:.1f}")
        return value

    def ask(self, request, idle=20):
        return self.chip.ask(request, idle=idle)

    # ---- one row of the table ----

    def row(self, name, exchanges, limit=None, octet=None):
        """The worst of some exchanges; limit: on T_SDR of the answer; octet: on the cycles an octet takes, in and out."""
        length = max(len(e.arrived) for e in exchanges)
        inside = self.most(name, "octet", max(e.spent(e.arrived[-1]) / len(e.arrived) for e in exchanges))
        out = max(e.spent((e.written or [e.end])[0]) / len(e.arrived) for e in exchanges)
        if octet:
            self.most(name, octet, out)
        stay = self.most(name, "interrupt", max(max(e.stays, default=0) for e in exchanges))
        wait = self.most(name, "wait", max(max(e.waits()) for e in exchanges))
        self.check(f"{name}: each octet in time for the next", wait < 11 * self.bit, f"{wait:.0f} cycles")
        left = min(e.left() for e in exchanges)
        text = f"{self.rate:6d}  {name:22s} {length:4d}   {inside:5.1f}  {out:5.1f}    {stay:5.0f}    {wait:4.0f}"
        if limit:
            turn, gap = self.timing(name, exchanges, limit)
            real = turn + REAL_BITS + REAL_CYCLES / self.bit
            self.check(f"{name}: max T_SDR of the GSD file", real <= MAX_T_SDR[self.rate], f"{real:.1f}")
            text += f"    {turn:5.1f}  {real:5.1f}     {gap:4.0f}   {gap - self.bit:4.0f}"
        self.rows.append(f"{text:100s}{100 * left:3.0f} %")

    def timing(self, name, exchanges, limit):
        """-> T_SDR [T_bit] and gap [machine cycles] of the answers, at worst."""
        turn = max(e.turn for e in exchanges) / self.bit
        gap = max(max(e.gaps(11 * self.bit), default=0) for e in exchanges)
        self.check(f"{name}: min T_SDR", min(e.turn for e in exchanges) / self.bit >= 11)
        self.most(name, limit, turn)
        # the real part raises TI one bit earlier: what is written within a bit time leaves no gap
        self.check(f"{name}: gap", gap < self.bit, f"{gap:.0f} cycles of {self.bit:.0f}")
        for e in exchanges:
            self.check(f"{name}: parity", e.parity == [parity(o) for o in e.answer], e.parity)
            self.check(f"{name}: driver", [on for _, on in e.driver] == [1, 0], e.driver)
        return turn, gap

    # ---- what is asked ----

    def scene(self):
        """As a master does it: with pauses, asking for the diagnosis until the slave is ready."""
        before = None
        for name, request, answer, limit in SCENE:
            exchange, repeats = self.ask_again(request)
            for _ in range(5):
                if exchange.answer != octets(NOT_YET):
                    break
                self.ask_again(DIAG_7D)  # twice a turn, so that FCB comes out the same
                exchange, _ = self.ask_again(DIAG)
            self.check(name, exchange.answer == octets(answer), f"{exchange.answer.hex(' ')} instead of {answer.lower()}")
            self.check(f"{name}: repeats", repeats == 0, repeats)
            if exchange.written:
                self.row(name, [self.middle(exchange, before, request) if limit == AGAIN else exchange], limit)
            before = request

    def middle(self, exchange, before, request):
        """Of five: where the main loop locks when the request begins, which is luck, it is not awaited (every_phase())."""
        five = [exchange] + [self.ask_again(r)[0] for _ in range(4) for r in (before, request)][1::2]
        return sorted(five, key=lambda e: e.turn)[2]

    def ask_again(self, request):
        """-> exchange, repeats"""
        for repeats in range(RETRIES + 1):
            exchange = self.ask(octets(request), MASTER_PAUSE)
            if exchange.answer:
                break
        return exchange, repeats

    def silent(self):
        """Nobody answers for another station; an octet with wrong parity drops the telegram, and the next is heard."""
        exchange = self.ask(octets(FOREIGN), 12000)
        self.check("a telegram for another station", not exchange.answer, exchange.answer.hex(" "))
        self.row("for another station", [exchange])
        self.chip.spoil(4)
        exchange = self.ask(octets(STATUS), 12000)
        self.check("wrong parity", not exchange.answer, exchange.answer.hex(" "))
        exchange, _ = self.ask_again(STATUS)
        self.check("the telegram after wrong parity",
                   exchange.answer in (octets("10 02 05 02 09 16"), octets("10 02 05 00 07 16")), exchange.answer.hex(" "))

    def every_phase(self, name, requests, limit):
        """None is lost, wherever the main loop is when it begins, and none is late; a turn of the loop is some 900 cycles."""
        exchanges = [self.ask(octets(requests[i % len(requests)]), 20 + 27 * i) for i in range(PHASES)]
        lost = sum(not e.answer for e in exchanges)
        self.check(f"{PHASES} {name}", lost == 0, f"{lost} not answered")
        if not lost:
            self.row(f"{PHASES} {name}", exchanges[1:], limit)  # before the first one there was something else

    def share(self, name, what, requests, period=0):
        """Of the main loop while telegrams come back to back, or every so many cycles."""
        exchanges = []
        for i, request in enumerate(requests * 4):
            if exchanges:
                self.chip.wait_until(exchanges[0].begin + i * period)
            exchanges.append(self.ask(octets(request)))
        (begin, before), (end, after) = exchanges[0].busy[0], exchanges[-1].busy[-1]
        left = 100 * (1 - (after - before) / (end - begin))
        self.check(f"main loop under {name}", left >= BUDGET[self.rate, what], f"{left:.1f} %")
        self.rows.append(f"{f'{self.rate:6d}  {name}':100s}{left:3.0f} %")

    def longest(self):
        """The longest telegrams back to back: to others, the next to this station right after T_SYN; to this station,
        refused at their end: the first because Data_Exchange takes no such length, which ends data exchange, so RS from
        then on."""
        for _ in range(2):
            exchange = self.ask(sd2("04 02 7D" + "11" * 246))
            self.check("249 octets for another station", not exchange.answer, exchange.answer.hex(" "))
            status = self.ask(octets(STATUS))
            self.check("the telegram after 249 octets for others", status.answer == octets("10 02 05 00 07 16"),
                       status.answer.hex(" "))
        self.row("for another station", [exchange], octet="foreign_octet")
        length = int(BUDGET[self.rate, "own_length"])
        for i in range(3):
            exchange = self.ask(sd2(("05 02 7D", "05 02 5D")[i & 1] + "11" * (length - 3)))
            self.check(f"{length} octets", exchange.answer in (octets("10 02 05 03 0A 16"), octets("10 02 05 02 09 16")),
                       exchange.answer.hex(" "))
            if i == 0 and exchange.answer:
                self.row("Data_Exchange, refused", [exchange], NEW, "own_octet")

    def stack(self):
        deepest, worst = measured_and_computed(IMAGE, self.chip.highest_sp())
        self.check("stack", 20 < deepest <= worst, f"{deepest} octets, by the calls {worst}")
        return f"stack at {self.rate} bit/s: {deepest} octets, by the calls {worst}"


def play(n):
    """-> rows of the table, what is to be said of the stack"""
    with s51.Chip(IMAGE, measured=True) as chip:
        bench = Bench(chip, n)
        bench.scene()
        bench.silent()
        bench.every_phase("Data_Exchange", (DX_7D, DX_5D), CYCLIC)
        bench.every_phase("different ones", (DIAG, STATUS, DX_7D), NEW)
        bench.share("Data_Exchange, on and on", "share_dx", (DX_7D, DX_5D))
        if (bench.rate, "share_dx_5ms") in BUDGET:  # at 9600 an exchange takes longer
            bench.share("Data_Exchange, each 5 ms", "share_dx_5ms", (DX_7D, DX_5D), 5000)
        bench.share("for another, on and on", "share_foreign", (FOREIGN, FOREIGN))
        bench.longest()
        bench.check("the rate", chip.value("RCAP2L") == 256 - n)  # the baud search has not left it
        return bench.rows, bench.stack()


def main():
    with ThreadPoolExecutor() as pool:
        found = list(pool.map(play, RATES))
    print(HEADING)
    for rows, _ in found:
        print("\n".join(rows))
    for _, stack in found:
        print(stack)
    failed = results.count(False)
    if "--figures" not in sys.argv:
        print(f"-----------------------\n{len(results)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
