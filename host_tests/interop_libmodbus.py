#!/usr/bin/env python3
"""Starts a station and lets the libmodbus program (interop_libmodbus.c) drive it; its Unity lines are the result."""
import subprocess
import sys

from station import Station

with Station("fieldling-modbus", "--address", "17", "--map", "host_tests/modbus_image.txt") as station:
    sys.exit(subprocess.run(["build/test/interop_libmodbus", station.pty], timeout=100, check=False).returncode)
