#!/usr/bin/env python3
"""The cases of s51_states.py with DP-TEST01 of the STC89C58RD+ board, at every rate of its 24 MHz, the data flash played.

usage: s51_stc89_long.py [WORD ...]    only cases with all these words in their name
"""
import sys

import s51_states
from s51_stc89 import dp_line

LINES = [dp_line(9600, 78), dp_line(19200, 39), dp_line(93750, 8), dp_line(187500, 4)]

if __name__ == "__main__":
    sys.exit(s51_states.main(LINES, s51_states.CASES, sys.argv[1:]))
