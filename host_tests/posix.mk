# The port in real time and the host stations on it.

UNIT_TESTS += test_hal_realtime
test_hal_realtime_SRC = $(HAL_REALTIME)

SCRIPT_TESTS += host_tests/station_cli.py host_tests/station_console.py host_tests/station_line.py host_tests/demo.py \
                host_tests/host_states.py

# How near the station comes to a loop that only reads and writes.
PROGRAMS += bench-pty
bench-pty_SRC = host_tests/bench_pty.c
BENCHES += bench-posix
bench-posix: build/posix/bench-pty build/posix/fieldling-dp
	@build/posix/bench-pty build/posix/fieldling-dp

UNIT_TESTS += test_hal_tty
test_hal_tty_SRC    = $(HAL_REALTIME)
test_hal_tty_LDLIBS = -Wl,--wrap=ioctl
