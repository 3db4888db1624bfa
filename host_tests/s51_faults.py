#!/usr/bin/env python3
"""Line faults and the 8051's two levels of interrupt, where an octet lasts 117 and 59 machine cycles: what is wrong is never
answered, the next good request is not lost, not once, and the counters say what it was.

usage: s51_faults.py [WORD ...]    only cases with all these words in their name
"""
import os
import random
import sys

import s51_states
from chip import FDL_COUNTERS
from dp_cases import DX, DX_OK, GET_DIAG, STATUS, STATUS_OK, TO_DATA_EXCH
from chip_board import LOOP, SYN
from s51_states import Line
from station import expect

LATE = 400  # max T_SDR is s51_dp.py's business
LINES = [Line(93750, 4, 12, "fieldling-dp", max_t_sdr=LATE), Line(187500, 2, 12, "fieldling-dp", max_t_sdr=LATE)]
CASES = []
LOCK = 320  # machine cycles: main's longest lock while telegrams come, a little more


def case(name):
    def keep(function):
        CASES.append((name, function))
        return function
    return keep


def once(bench, request, answer, **counted):
    """The answer without a repetition, and what has been counted (low octets); others of these counters have not moved."""
    board = bench.board
    before = {name: board.counter(name) for name in counted}
    expect(request, board.ask(request), answer)
    expect(request, {name: board.counter(name) - n & 0xFF for name, n in before.items()}, counted)


def alive(bench):
    once(bench, STATUS, STATUS_OK)


def spoilt(telegram, position):
    words = telegram.split()
    words[position] += "!"
    return " ".join(words)


@case("a bad octet sets T_SYN back: the telegram 18 T_bit behind it is not answered, 36 T_bit behind it is")
def syn_behind_a_bad_octet(bench):
    for begun in ("10 08 02!", "10 08 02 49 53!", "10 08! _36 55!", "10 08 _24 02!", "10 08 _26 02!", "10 08 _28 02!",
                  "10 08 _30 02!", "10 08 _32 02!", "10 08 _34 02!", "68 05 05 68 88 82!"):
        once(bench, f"{begun} _18 {STATUS}", "", parity=begun.count("!"))
        once(bench, f"{begun} _36 {STATUS}", STATUS_OK, parity=begun.count("!"))


@case("a bad octet at any place: not answered, counted once")
def bad_octet(bench):
    bench.steps(TO_DATA_EXCH)
    for telegram in (STATUS, DX, GET_DIAG):
        for position in range(len(telegram.split())):
            once(bench, spoilt(telegram, position), "", parity=1, requests=0)
            alive(bench)


def held(bench, text, begin, end):
    """-> the answer to the telegram; from begin to end, in machine cycles from its begin, main locks the service out."""
    board = bench.board
    board.turns(1)
    board.log = []
    words = text.split()
    for k, word in enumerate(words, 1):
        if word.endswith("!"):
            board.spoil(k)
    os.write(board.input, bytes(int(word[:2], 16) for word in words))
    unlocked = "hal_irq_restore"  # main has just left a locked section
    board.do(*board.until_later(begin, unlocked), "EX1=0", *board.until_later(end - begin, unlocked), "EX1=1",
             *board.until_later(len(words) * 11 * board.bit, SYN), *board.until(LOOP, 3))
    try:
        return os.read(board.output, 4096).hex(" ").upper()
    except BlockingIOError:
        return ""


@case("a bad octet while main holds the service back: not answered, counted once, the next request is answered")
def bad_octet_under_the_lock(bench):
    for position in range(len(STATUS.split())):
        octet = 11 * bench.board.bit
        for begin in range(0, int(position * octet), 80):
            before = bench.board.counter("parity")
            expect(f"octet {position} bad", held(bench, spoilt(STATUS, position), begin, begin + LOCK), "")
            alive(bench)
            expect("parity", bench.board.counter("parity") - before & 0xFF, 1)


if __name__ == "__main__":
    sys.exit(s51_states.main(LINES, CASES, sys.argv[1:]))
