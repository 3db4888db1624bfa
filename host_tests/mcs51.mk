# 8051 images in the simulator s51, and their budgets.

SCRIPT_TESTS_ONCE += host_tests/s51_dp.py host_tests/s51_masters.py
host_tests/s51_dp.py_TIMEOUT      := 300
host_tests/s51_masters.py_TIMEOUT := 300

BENCHES += bench-s51
bench-s51: build/87c51fb/fieldling-dp.ihx
	@echo "DP-TEST01 on a 12 MHz 87C51FB, simulated machine cycles:"
	@python3 host_tests/s51_dp.py

run-board-87c51fb: build/posix/fieldling-master build/87c51fb/fieldling-dp.ihx
	@python3 host_tests/run_board.py 87c51fb

# make size and make check: every image within its board's budget.txt
MCS51_BUDGETS = $(foreach b,87c51fb,$(wildcard boards/$b/budget.txt))
SIZES  += size-mcs51
STATIC += size-mcs51
size-mcs51: build/87c51fb/fieldling-dp.ihx
	@python3 host_tests/mcs51_size.py boards/87c51fb/budget.txt
