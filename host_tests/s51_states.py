#!/usr/bin/env python3
"""DP-TEST01 on the 87C51FB, in the simulator s51: every case of dp_cases.py by telegram, in simulated time.

usage: s51_states.py [WORD ...]    only cases with all these words in their name

A request that gets no answer is repeated, as a master does (max_retry); how often that was needed is printed.
"""
import queue
import sys
import threading
import time
from pathlib import Path

from dp_cases import CASES
from station import expect

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from chip_board import Board  # noqa: E402

IMAGE = str(ROOT / "build" / "87c51fb" / "fieldling-dp.ihx")
RATES = {39: 9600, 4: 93750}  # divisor of Timer 2 at 12 MHz
ADDRESS, INPUTS = 8, "1E 00"
RETRIES = 3
BOARDS = 4  # at a time: each sleeps for most of its time (chip_board.py)


class Bench:
    """Plays the steps of a case on a board."""

    def __init__(self, board):
        self.board, self.repeats = board, 0
        self.power, self.ms, self.new_battery = board.power, board.ms, board.new_battery

    def play(self, steps):
        self.board.inputs(INPUTS)
        self.power(ADDRESS)
        for verb, *arguments in steps:
            getattr(self, verb)(*arguments)

    def ask(self, request, expected):
        answer = self.board.ask(request)
        for _ in range(RETRIES if expected else 0):
            if answer:
                break
            self.repeats += 1
            answer = self.board.ask(request)
        expect(request, answer, expected)

    def inputs(self, text):
        self.board.inputs(text)
        self.ms(5)

    def out(self, expected):
        expect("outputs", self.board.out(), expected)


def work(rate_n, cases, results):
    """Cases until there are none left -> (case, rate, what was wrong, repeats)"""
    with Board(IMAGE, rate_n) as board:
        while True:
            try:
                name, steps = cases.get_nowait()
            except queue.Empty:
                return
            bench, wrong = Bench(board), ""
            try:
                bench.play(steps)
            except Exception as error:  # whatever it is, it is this case's failure, and the next one begins anew
                wrong = f"{type(error).__name__}: {error}"
            results.append((name, RATES[rate_n], wrong, bench.repeats))


def play_all(rate_n, cases):
    waiting, results = queue.Queue(), []
    for item in cases:
        waiting.put(item)
    threads = [threading.Thread(target=work, args=(rate_n, waiting, results)) for _ in range(min(BOARDS, len(cases)))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def main(words):
    cases = [item for item in CASES if all(word in item[0] for word in words)]
    count = failed = 0
    for rate_n, rate in RATES.items():
        begin = time.monotonic()
        results = play_all(rate_n, cases)
        for name, _, wrong, _ in sorted(results):
            print(f"{__file__}:0:{name} at {rate}:" + (f"FAIL: {wrong}" if wrong else "PASS"))
        count += len(cases)
        failed += len(cases) - sum(not wrong for _, _, wrong, _ in results)  # a board that died leaves cases undone
        print(f"{rate} bit/s: {len(cases)} cases, {sum(r[3] for r in results)} requests repeated, "
              f"{time.monotonic() - begin:.0f} s")
    print(f"\n{count} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
