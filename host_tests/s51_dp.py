#!/usr/bin/env python3
"""DP-TEST01 on the 87C51FB, in the simulator s51: answers, their timing to the machine cycle, parity, the driver.

usage: s51_dp.py [--figures]     the table of figures alone

Expected telegrams are worked out by hand: address 5, master 2, EN 50170-2 part 8; FCS is the sum modulo 256.
A request that gets no answer is repeated, as a master does (max_retry); how often that was needed is printed.
"""
import sys
from pathlib import Path

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
CYCLIC, NEW = "T_SDR", "T_SDR_new"
SCENE = [
    ("FDL status", STATUS, "10 02 05 00 07 16", CYCLIC),
    ("Slave_Diag", DIAG_FIRST, "68 0B 0B 68 82 85 08 3E 3C 02 05 00 FF 12 34 D5 16", NEW),
    ("Set_Prm", SET_PRM, "E5", CYCLIC),
    ("Chk_Cfg", CHK_CFG, "E5", CYCLIC),
    ("Slave_Diag", DIAG, "68 0B 0B 68 82 85 08 3E 3C 00 04 00 02 12 34 D5 16", NEW),
    ("Slave_Diag", DIAG_7D, "68 0B 0B 68 82 85 08 3E 3C 00 04 00 02 12 34 D5 16", CYCLIC),
    ("Data_Exchange", DX_5D, "68 05 05 68 02 05 08 00 00 0F 16", NEW),
    ("Data_Exchange", DX_7D, "68 05 05 68 02 05 08 33 44 86 16", CYCLIC),
]
RATES = {39: 9600, 4: 93750, 2: 187500}  # by the divisor of Timer 2 at 12 MHz
RETRIES = 3
PHASES = 24
# between two requests [instructions]: the main loop's turn, so that the next answer shows what the last request did
MASTER_PAUSE = 24000

BUDGET = {(int(rate), what): float(limit) for rate, what, limit in
          (line.split() for line in (ROOT / "boards" / "87c51fb" / "timing.txt").read_text().splitlines()
           if line and not line.startswith("#"))}
REAL_BITS, REAL_CYCLES = 0.5, 4  # later on the real part, at most: a start bit waits up to a bit, RI is half a bit earlier;
                                 # two interrupts are entered, two cycles each

results = []


def check(name, good, detail=""):
    results.append(bool(good))
    if not good:
        print(f"{name}:FAIL: {detail}")


def octets(text):
    return bytes.fromhex(text)


def ask(chip, request):
    """-> (exchange, repeats)"""
    for repeats in range(RETRIES + 1):
        exchange = chip.ask(octets(request), idle=MASTER_PAUSE)
        if exchange.answer:
            break
    return exchange, repeats


def until_ready(chip, exchange):
    """A master polls Slave_Diag until the slave is ready; twice a turn, so that FCB comes out the same."""
    for _ in range(5):
        if exchange.answer != octets(NOT_YET):
            break
        ask(chip, DIAG_7D)
        exchange, _ = ask(chip, DIAG)
    return exchange


def parity(octet):
    return bin(octet).count("1") & 1


def timing(rate, n, name, exchange, limit):
    """T_SDR and gap of an answer, in T_bit and machine cycles."""
    bit = n * 8 / 3
    turn = exchange.turn / bit
    gap = max(exchange.gaps(11 * bit), default=0)
    check(f"{name} at {rate}: T_SDR", 11 <= turn <= BUDGET[rate, limit], f"{turn:.1f} T_bit")
    # the real part raises TI one bit earlier: what is written within a bit time leaves no gap
    check(f"{name} at {rate}: gap", gap < bit, f"{gap:.0f} cycles of {bit:.0f}")
    check(f"{name} at {rate}: parity", exchange.parity == [parity(o) for o in exchange.answer], exchange.parity)
    check(f"{name} at {rate}: driver", [on for _, on in exchange.driver] == [1, 0], exchange.driver)
    return turn, gap


def scene(n):
    rate = RATES[n]
    with s51.Chip(IMAGE) as chip:
        chip.wait_for_rate(n)
        for name, request, answer, limit in SCENE:
            exchange, repeats = ask(chip, request)
            exchange = until_ready(chip, exchange)
            check(f"{name} at {rate}", exchange.answer == octets(answer),
                  f"{exchange.answer.hex(' ')} instead of {answer.lower()}")
            if not exchange.written:
                continue
            turn, gap = timing(rate, n, name, exchange, limit)
            check(f"{name} at {rate}: repeats", repeats == 0, repeats)
            real = turn + REAL_BITS + REAL_CYCLES / (n * 8 / 3)
            print(f"{rate:6d}  {name:14s} T_SDR {turn:6.1f} T_bit (real part: up to {real:6.1f})   "
                  f"TI to next octet {gap:4.0f} cycles (real part: {gap - n * 8 / 3:4.0f})")
        silent(chip, rate)
        every_phase(chip, rate)
        share(chip, n, rate)
        longest(chip, rate)
        stack(chip, rate)


def stack(chip, rate):
    deepest, worst = measured_and_computed(IMAGE, chip.highest_sp())
    check(f"stack at {rate}", 20 < deepest <= worst, f"{deepest} octets, by the calls {worst}")
    print(f"{rate:6d}  stack: {deepest} octets, by the calls {worst}")


def silent(chip, rate):
    """Nobody answers for another station; an octet with wrong parity drops the telegram, and the next is heard."""
    exchange = chip.ask(octets(FOREIGN), idle=12000)
    check(f"a telegram for another station at {rate}", not exchange.answer, exchange.answer.hex(" "))
    chip.spoil(4)
    exchange = chip.ask(octets(STATUS), idle=12000)
    check(f"wrong parity at {rate}", not exchange.answer, exchange.answer.hex(" "))
    exchange, _ = ask(chip, STATUS)
    check(f"the telegram after wrong parity at {rate}", exchange.answer == octets("10 02 05 02 09 16")
          or exchange.answer == octets("10 02 05 00 07 16"), exchange.answer.hex(" "))


def sd2(body):
    """A telegram of variable length around DA SA FC and data, in hexadecimal."""
    data = octets(body)
    return bytes([0x68, len(data), len(data), 0x68]) + data + bytes([sum(data) & 0xFF, 0x16])


def every_phase(chip, rate):
    """No request is lost, wherever the main loop is when it begins; a turn of the loop is some 900 cycles."""
    lost = 0
    for i in range(PHASES):
        lost += not chip.ask(octets((DX_7D, DX_5D)[i & 1]), idle=20 + 27 * i).answer
    check(f"requests at {PHASES} phases of the main loop at {rate}", lost == 0, f"{lost} not answered")


def longest(chip, rate):
    """The longest telegrams back to back: to others, the next to this station right after T_SYN; to this station, refused
    at their end: the first because Data_Exchange takes no such length, which ends data exchange, so RS from then on."""
    for i in range(2):
        before = chip.times()
        exchange = chip.ask(sd2("04 02 7D" + "11" * 246), idle=20)
        after = chip.times()
        check(f"249 octets for another station at {rate}", not exchange.answer, exchange.answer.hex(" "))
        exchange = chip.ask(octets(STATUS), idle=20)
        check(f"the telegram after 249 octets for others at {rate}", exchange.answer == octets("10 02 05 00 07 16"),
              exchange.answer.hex(" "))
    spent = (after[1] - before[1]) / 255
    check(f"cycles an octet for others at {rate}", spent <= BUDGET[rate, "foreign_octet"], f"{spent:.1f}")
    print(f"{rate:6d}  {'foreign':14s} 249 octets: {spent:.1f} cycles an octet, the decision included")
    length = int(BUDGET[rate, "own_length"])
    for i in range(3):
        exchange = chip.ask(sd2(("05 02 7D", "05 02 5D")[i & 1] + "11" * (length - 3)), idle=20)
        check(f"{length} octets at {rate}", exchange.answer in (octets("10 02 05 03 0A 16"), octets("10 02 05 02 09 16")),
              exchange.answer.hex(" "))


def share(chip, n, rate):
    """Of the main loop, under Data_Exchange back to back and every 5 ms, and under foreign telegrams back to back."""
    octet = n * 88 / 3
    for name, what, requests, period in (("Data_Exchange", "share_dx", (DX_7D, DX_5D), 0),
                                         ("Data_Exchange", "share_dx_5ms", (DX_7D, DX_5D), 5000),
                                         ("foreign", "share_foreign", (FOREIGN, FOREIGN), 0)):
        if period and period < 30 * octet:
            continue  # an exchange takes longer
        before = chip.times()
        for i, request in enumerate(requests * 4):
            while chip.times()[0] < before[0] + i * period:
                chip.step(100)
            chip.ask(octets(request), idle=20)
        after = chip.times()
        left = 100 * (1 - (after[1] - before[1]) / (after[0] - before[0]))
        check(f"main loop under {name} at {rate}", left >= BUDGET[rate, what], f"{left:.1f} %")
        print(f"{rate:6d}  {name:14s} {'every 5 ms' if period else 'back to back'}: "
              f"{left:.0f} % of the time is left to the main loop")


def main():
    for n in RATES:
        scene(n)
    failed = results.count(False)
    print("-----------------------")
    print(f"{len(results)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
