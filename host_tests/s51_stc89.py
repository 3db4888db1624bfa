#!/usr/bin/env python3
"""The images of the STC89C58RD+ board in the simulator s51, at 24 MHz, with the data flash played: the Modbus inverter in
the RAM on the chip, DP-TEST01 with RAM outside.
Every case of DP at every rate: s51_stc89_long.py.

Answers are worked out by hand as in s51_modbus.py.
"""
import sys
from pathlib import Path

from station import expect, run_tests

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from s51_states import CASES, Line, play_all  # noqa: E402
from stc89 import AUXR, MHZ, StcBoard, StcModbus  # noqa: E402

MODBUS, DP = (str(ROOT / f"build/stc89c58rd/fieldling-{name}.ihx") for name in ("modbus", "dp"))
N_19200, N_9600 = 39, 78
RATE_9600, ODD = 4, 0x08

READ_10 = "01 03 00 00 00 0A C5 CD"
TEN = "01 03 14 13 88 00 00 17 70 00 32 00 32 13 88 01 90 03 52 00 3C 00 00 BC 02"
SET_1234 = "01 06 00 00 04 D2 0B 57"
READ_1 = "01 03 00 00 00 01 84 0A"
STORE, STORE_ACKNOWLEDGE = "01 06 00 0A 00 01 68 08", "01 86 05 82 63"
TURNS = 20  # of the main loop: an octet is stored a turn


def ask(chip, request, expected):
    exchange = chip.ask(bytes.fromhex(request))
    expect(f"answer to {request}", exchange.answer.hex(" ").upper(), expected)
    return exchange


def store(chip, set_point):
    """Write the set point and keep it: each saved parameter that has changed costs a record of the data flash."""
    ask(chip, set_point, set_point)
    ask(chip, STORE, STORE_ACKNOWLEDGE)
    chip.run_to("mb_poll", times=TURNS)


def crc(text):
    """With the CRC of Modbus over serial line 6.2.2, by its bitwise rule."""
    octets = bytes.fromhex(text)
    value = 0xFFFF
    for octet in octets:
        value ^= octet
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return (octets + value.to_bytes(2, "little")).hex(" ").upper()


def test_modbus_at_19200_and_9600_in_the_ram_on_the_chip():
    for n, line, odd in ((N_19200, 0, 0), (N_9600, RATE_9600 | ODD, 1)):
        with StcModbus(MODBUS, n, line) as chip:
            expect("RAM on the chip", chip.value(f"sfr[0x{AUXR:x}]"), 0)
            exchange = ask(chip, READ_10, TEN)
            expect("ninth bits", exchange.parity, [bin(octet).count("1") & 1 ^ odd for octet in exchange.answer])
            expect("driver", [on for _, on in exchange.driver], [1, 0])
            ask(chip, crc("01 14 07 06 00 01 00 00 00 01"), crc("01 94 01"))  # no files


def test_parameters_are_kept_in_the_data_flash():
    with StcModbus(MODBUS, N_19200) as chip:
        store(chip, SET_1234)
        chip.power()
        ask(chip, READ_1, crc("01 03 02 04 D2"))
        expect("erased", chip.value("erases"), 0)


def test_a_full_log_is_renewed_and_keeps_what_it_holds():
    with StcModbus(MODBUS, N_19200) as chip:
        for n in range(17):
            store(chip, crc(f"01 06 00 00 01 {n:02X}"))
        expect("erased", chip.value("erases") > 0, True)
        chip.power()
        ask(chip, READ_1, crc("01 03 02 01 10"))


def play(line, cases):
    results = play_all(line, cases)
    expect(f"{line.rate} bit/s, {len(cases)} cases", [(name, wrong) for name, wrong, _ in results if wrong], [])
    expect("cases played", len(results), len(cases))


def dp_line(rate, n):
    return Line(rate, n, MHZ, "fieldling-dp", StcBoard)


def some(*words):
    return [item for item in CASES if any(word in item[0] for word in words)]


def test_dp_exchanges_data_and_keeps_its_address_at_187_5_kbit_s():
    play(dp_line(187500, 4), some("T71", "T60 ", "driver"))


def test_dp_at_19200():
    play(dp_line(19200, 39), some("T71 the address"))


def test_the_ram_outside_is_chosen_before_it_is_cleared():
    board = StcBoard(DP, 4, MHZ)
    try:
        board.do(f"reset\nset mem xram 0x{board.symbols['fdl_counters']:x} 0xa5", *board.until_event(f"sfr w 0x{AUXR:x}"))
        expect("AUXR", board.value(f"sfr[0x{AUXR:x}]"), 2)
        expect("not yet cleared", board.value(f"xram[0x{board.symbols['fdl_counters']:x}]"), 0xA5)
        board.power(8)
        expect("cleared", board.counter("parity"), 0)
    finally:
        board.close()


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
