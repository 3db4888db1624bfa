#!/usr/bin/env python3
"""The Modbus inverter on the 87C51FB, in the simulator s51: answers, formats, parity, and what they cost to the machine cycle.

Answers are worked out by hand, Modbus application protocol 6; CRC by the bitwise rule of Modbus over serial line 6.2.2. The
simulator raises RI and TI at the end of the character; the real part half a bit and one bit earlier, and enters an interrupt
two cycles later: those are added here.
"""
import os
import sys
from pathlib import Path

from station import expect, run_tests

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from chip_modbus import ASCII, NONE, ODD, RATE_9600, ModbusChip  # noqa: E402

IMAGE = "build/87c51fb/fieldling-modbus.ihx"
IMAGE_11059 = "build/87c51fb/fieldling-modbus-11059.ihx"
N_9600_12, N_9600_11059, N_19200_11059 = 39, 36, 18
ENTRY = 2  # cycles of a real interrupt entry that s51 does not count

READ_10 = "01 03 00 00 00 0A C5 CD"
TEN = "01 03 14 13 88 00 00 17 70 00 32 00 32 13 88 01 90 03 52 00 3C 00 00 BC 02"
RUN = ("01 05 00 00 FF 00 8C 3A", "01 05 00 00 FF 00 8C 3A")
SCENE = [
    (READ_10, TEN),
    ("01 01 00 00 00 01 FD CA", "01 01 01 00 51 88"),
    ("01 06 00 00 04 D2 0B 57", "01 06 00 00 04 D2 0B 57"),
    ("01 10 00 00 00 01 02 03 E8 A6 EE", "01 10 00 00 00 01 01 C9"),
    RUN,
    ("01 0F 00 00 00 02 01 00 DE 97", "01 0F 00 00 00 02 D4 0A"),
    ("01 08 00 00 A5 37 DA 8D", "01 08 00 00 A5 37 DA 8D"),
    ("01 41 C0 10", "01 C1 01 B0 50"),
]
ERRORS_0 = ("01 08 00 0C 00 00 20 08", "01 08 00 0C 00 00 20 08")
ERRORS_1 = ("01 08 00 0C 00 00 20 08", "01 08 00 0C 00 01 E1 C8")


def octets(text):
    return bytes.fromhex(text)


def limits():
    rows = (line.split("#")[0].split() for line in (ROOT / "boards/87c51fb/budget.txt").read_text().splitlines())
    return {words[0]: int(words[1]) for words in rows if len(words) == 2}


def ask(chip, pair, **more):
    exchange = chip.ask(octets(pair[0]), **more)
    expect(f"answer to {pair[0]}", exchange.answer.hex(" ").upper(), pair[1])
    return exchange


def ninth_bits(exchange, odd=0):
    expect("ninth bits", exchange.parity, [bin(octet).count("1") & 1 ^ odd for octet in exchange.answer])


def test_the_scene_at_9600():
    with ModbusChip(IMAGE, N_9600_12) as chip:
        for pair in SCENE:
            exchange = ask(chip, pair)
            ninth_bits(exchange)
            expect("driver", [on for _, on in exchange.driver], [1, 0])


def test_a_rate_the_crystal_has_not_is_9600_and_19200_is_what_11059_has():
    for image, n in ((IMAGE, N_9600_12), (IMAGE_11059, N_19200_11059)):
        with ModbusChip(image, n) as chip:
            ask(chip, SCENE[0])


def test_odd_parity():
    with ModbusChip(IMAGE_11059, N_9600_11059, line=ODD | RATE_9600) as chip:
        ninth_bits(ask(chip, SCENE[0]), odd=1)


def test_two_stop_bits():
    with ModbusChip(IMAGE, N_9600_12, line=NONE) as chip:
        exchange = ask(chip, SCENE[0])
        expect("ninth bits", set(exchange.parity), {1})


def with_parity(text):
    """Seven bits and even parity as the eighth."""
    return bytes(c | (bin(c).count("1") & 1) << 7 for c in text.encode())


def test_ascii_with_seven_bits_and_even_parity():
    with ModbusChip(IMAGE, N_9600_12, line=ASCII) as chip:
        exchange = chip.ask(with_parity(":010300000001FB\r\n"))  # LRC: -(01 + 03 + 01)
        expect("answer", exchange.answer, with_parity(":01030213885F\r\n"))  # -(01 + 03 + 02 + 13 + 88)


def test_a_wrong_parity_bit_drops_the_request_and_is_counted():
    with ModbusChip(IMAGE, N_9600_12) as chip:
        ask(chip, ERRORS_0)
        chip.spoil(3)
        expect("octets sent", chip.tell(octets(READ_10)), 0)
        ask(chip, ERRORS_1)


def cut(chip, octet_cycles, after):
    """READ_10 with a silence of `after` characters behind its third octet."""
    chip.log = []
    os.write(chip.input, octets(READ_10)[:3])
    for _ in range(3):
        chip.run_to("line_octet_isr")
    start = chip.cycles
    while chip.cycles < start + after * octet_cycles:
        chip.step(50)
    os.write(chip.input, octets(READ_10)[3:])


def test_a_gap_of_one_character_is_none_and_one_of_two_spoils_the_frame():
    with ModbusChip(IMAGE, N_9600_12) as chip:
        cut(chip, 1144, 1.0)
        chip.run_to("line_sent_isr")
        expect("answer", os.read(chip.output, 99), octets(TEN))
        chip.run_to("mb_poll")
        cut(chip, 1144, 2.0)
        chip.run_to("mb_frame_end_isr")
        for _ in range(5):
            chip.run_to("mb_poll")
        expect("nothing sent", [e for e in chip.log if e[0] == "TX"], [])
        ask(chip, SCENE[0])


def receive(chip, request):
    """-> machine cycles in interrupts from one octet's upcall to the next's: all that an octet takes. Two interrupts each."""
    chip.run_to("mb_poll")
    os.write(chip.input, request)
    spent = []
    for _ in request:
        chip.run_to("line_octet_isr")
        spent.append(chip.times()[1])
    chip.run_to("line_sent_isr")
    os.read(chip.output, 4096)
    return [b - a + 2 * ENTRY for a, b in zip(spent, spent[1:])]


def passes(chip, exchange):
    """Machine cycles of the main loop's passes while the answer is sent."""
    ends = [t for kind, value, t in chip.log if (kind, value) == ("AT", 1) and t > exchange.written[0]]
    return [b - a for a, b in zip(ends, ends[1:])]


def measure(image, n, rate):
    """With the drive ramping up, whose model then has most to do. A request waits for the pass that is being made: no
    answer comes later than the quickest one and the longest pass after the end of t3.5."""
    octet, bit = n * 88 / 3, n * 8 / 3
    turns, taken, gaps, longest = [], [], [], []
    with ModbusChip(image, n) as chip:
        ask(chip, RUN)
        chip.watch_idle()
        before = chip.times()
        for k in range(25):
            exchange = ask(chip, SCENE[0], passes=1 + 7 * k % 11)
            silence = max(t for kind, value, t in chip.log if (kind, value) == ("T0", 0) and t < exchange.written[0])
            turns.append(exchange.written[0] - silence + ENTRY)
            longest += passes(chip, exchange)
            gaps.append(max(exchange.gaps(octet)) + bit + ENTRY)  # the real TI: one bit earlier
        after = chip.times()
        for _ in range(4):
            taken += receive(chip, octets(READ_10))
    left = 1 - (after[1] - before[1]) / (after[0] - before[0])
    worst = max(max(turns), min(turns) + max(longest))
    print(f"{rate:6d}  t3.5 to first octet {min(turns):.0f}, at most {worst:.0f} (seen {max(turns):.0f})   octet received {sum(taken) / len(taken):.0f}, "
          f"worst {max(taken):.0f}   TI to next octet {max(gaps):.0f} ({max(0, max(gaps) - bit) / bit:.2f} bit of gap)   main loop {left:.0%}")
    return min(turns), worst, sum(taken) / len(taken), max(taken), max(0, max(gaps) - bit)


def test_cycles_are_within_the_budget():
    most = limits()
    for image, n, rate in ((IMAGE, N_9600_12, 9600), (IMAGE_11059, N_19200_11059, 19200)):
        found = measure(image, n, rate)
        for name, value in zip(("modbus_turn_quickest", "modbus_turn_worst", "modbus_octet_mean", "modbus_octet_worst", "modbus_gap"), found):
            expect(f"{name} {value:.0f} within {most[name]}", value <= most[name], True)


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
