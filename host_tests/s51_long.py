#!/usr/bin/env python3
"""The cases of s51_states.py at every rate the chip has with 12 and 24 MHz, and those that take too long for `make test`:
thousands of exchanges and of chunks of noise, long watchdogs, each wrong bit, all address switches, every moment of the
main loop's turn. Half an hour of simulation and more.

usage: s51_long.py [WORD ...]    only cases with all these words in their name
"""
import sys

import s51_states
from s51_cases import LONG
from s51_states import CASES, LINES, Line

MORE = [Line(9600, 78, 24, "fieldling-dp-24mhz"), Line(19200, 39, 24, "fieldling-dp-24mhz"),
        Line(93750, 8, 24, "fieldling-dp-24mhz"), Line(187500, 4, 24, "fieldling-dp-24mhz")]

if __name__ == "__main__":
    sys.exit(s51_states.main(LINES + MORE, CASES + LONG, sys.argv[1:]))
