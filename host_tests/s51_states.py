#!/usr/bin/env python3
"""DP-TEST01 on the 87C51FB, in the simulator s51, in simulated time: every case of dp_cases.py by telegram, and those of
s51_cases.py.

usage: s51_states.py [WORD ...]    only cases with all these words in their name

A request that gets no answer is repeated, as a master does (max_retry); how often that was needed is printed. So is the
slowest answer to any request, and it must keep max T_SDR; not counted are cases that ask for a longer T_SDR.
"""
import queue
import sys
import threading
import time
import traceback
from collections import namedtuple
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "sim" / "s51"))
from chip_board import Board  # noqa: E402
import dp_cases  # noqa: E402
import s51_cases  # noqa: E402
from station import expect  # noqa: E402

# n: Timer 2's divisor; max_t_sdr in T_bit, EN 50170-2 allows 60
Line = namedtuple("Line", "rate n mhz image board max_t_sdr", defaults=(Board, 60))
LINES = [Line(9600, 39, 12, "fieldling-dp"), Line(93750, 4, 12, "fieldling-dp")]
ADDRESS, INPUTS = 8, "1E 00"
RETRIES = 3
BOARDS = 4  # at a time: each sleeps for most of its time (chip_board.py)


class Bench:
    """A board just switched on, for one case."""

    def __init__(self, board):
        self.board, self.repeats, self.slowest = board, 0, (0, "")
        self.power, self.ms, self.new_battery = board.power, board.ms, board.new_battery
        board.inputs(INPUTS)
        board.power(ADDRESS)

    def step(self, step):
        verb, *arguments = step
        getattr(self, verb)(*arguments)

    def steps(self, steps):
        for step in steps:
            self.step(step)

    def ask(self, request, expected):
        """"" is silence, None any answer."""
        answer = self.board.ask(request)
        for _ in range(0 if expected == "" else RETRIES):
            if answer:
                break
            self.repeats += 1
            answer = self.board.ask(request)
        if answer:
            self.slowest = max(self.slowest, (self.board.turn() / self.board.bit, request))
        if expected is None:
            expect(f"{request} is answered", bool(answer), True)
        else:
            expect(request, answer, expected)

    def inputs(self, text):
        self.board.inputs(text)
        self.ms(5)

    def out(self, expected):
        expect("outputs", self.board.out(), expected)


def table(name, steps):
    return name, lambda bench: bench.steps(steps)


CASES = [table(*item) for item in dp_cases.CASES] + s51_cases.CASES


def work(line, cases, results):
    """Cases until there are none left -> (case, what was wrong, its bench). Whatever happens in a case is its failure."""
    board = None
    while True:
        try:
            name, play = cases.get_nowait()
        except queue.Empty:
            break
        bench, wrong = None, ""
        try:
            board = board or line.board(str(ROOT / f"build/{line.board.FOLDER}/{line.image}.ihx"), line.n, line.mhz)
            bench = Bench(board)
            play(bench)
        except AssertionError as error:
            wrong = str(error)
        except Exception as error:  # the simulator is not to be trusted any more
            traceback.print_exc(file=sys.stdout)
            wrong = f"{type(error).__name__}: {error}"
            if board:
                board.close()
            board = None
        results.append((name, wrong, bench))
    if board:
        board.close()


def play_all(line, cases):
    waiting, results = queue.Queue(), []
    for item in cases:
        waiting.put(item)
    threads = [threading.Thread(target=work, args=(line, waiting, results)) for _ in range(min(BOARDS, len(cases)))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


def main(lines, cases, words):
    cases = [item for item in cases if all(word in item[0] for word in words)]
    failed = 0
    for line in lines:
        begin = time.monotonic()
        results = play_all(line, cases)
        turn, request = max((bench.slowest for name, _, bench in results if bench and "min_T_SDR" not in name),
                            default=(0, "nothing"))
        slowest = f"slowest answer {turn:.1f} T_bit after {request}"
        verdicts = [result[:2] for result in results]
        verdicts.append((f"max T_SDR is {line.max_t_sdr} T_bit", slowest if turn > line.max_t_sdr else ""))
        for name, wrong in sorted(verdicts):
            print(f"{__file__}:0:{name} at {line.rate}:" + (f"FAIL: {wrong}" if wrong else "PASS"))
        failed += len(cases) + 1 - sum(not wrong for _, wrong in verdicts)
        print(f"{line.rate} bit/s, {line.mhz} MHz: {len(cases)} cases, {sum(bench.repeats for *_, bench in results if bench)} "
              f"requests repeated, {slowest}, {time.monotonic() - begin:.0f} s", flush=True)
    print(f"\n{len(lines) * (len(cases) + 1)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(LINES, CASES, sys.argv[1:]))
