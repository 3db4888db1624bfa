# The wire and the other side of it. Nothing here is part of a station.

# The port in virtual time, for tests: test_x_SRC = $(HAL_VIRTUAL) ...
HAL_VIRTUAL = firmware/hal/posix/hal_virtual.c firmware/hal/posix/hal_virtual_line.c
