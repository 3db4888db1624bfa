# The port in real time and the host stations on it.

UNIT_TESTS += test_hal_realtime
test_hal_realtime_SRC = $(HAL_REALTIME)
