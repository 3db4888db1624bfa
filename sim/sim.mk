# The wire and the other side of it. Nothing here is part of a station, and nothing shares code with firmware/.

# The port in virtual time, for tests: test_x_SRC = $(HAL_VIRTUAL) ...
HAL_VIRTUAL = firmware/hal/posix/hal_virtual.c firmware/hal/posix/hal_virtual_line.c
# The segment and its judge, on that port.
SIM_SEGMENT = $(HAL_VIRTUAL) sim/segment.c sim/uart.c sim/telegram.c
# A DP master; needs neither of the two above.
SIM_MASTER = sim/dp_master.c sim/dp_questions.c sim/initiator.c sim/telegram.c
# A DP master with line faults on the segment.
SIM_BUS = $(SIM_SEGMENT) sim/bus.c sim/faults.c sim/dp_master.c sim/dp_questions.c sim/initiator.c

PROGRAMS += fieldling-segment
fieldling-segment_SRC = sim/fieldling_segment.c sim/faults.c
fieldling-segment_CFLAGS = -D_XOPEN_SOURCE=700
