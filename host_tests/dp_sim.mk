# Tests of the simulated wire, and of the DP station on it, in virtual time.

UNIT_TESTS += test_hal_virtual
test_hal_virtual_SRC = $(HAL_VIRTUAL)

UNIT_TESTS += test_segment
test_segment_SRC = $(SIM_SEGMENT)
