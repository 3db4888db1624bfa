# The host as a board: stations in real time over a pseudo terminal or a serial port.

# The port in real time, and what every host station shares: prog_SRC = $(HOST_STATION) ...
HAL_REALTIME = $(addprefix firmware/hal/posix/,hal_realtime.c line_pty.c line_tty.c nv_file.c con_stdio.c)
HOST_STATION = $(HAL_REALTIME) boards/posix/options.c boards/posix/console.c

PROGRAMS += fieldling-dp
fieldling-dp_SRC      = boards/posix/fieldling_dp.c boards/posix/dp_trace.c boards/posix/dp_words.c $(HOST_STATION) \
                        $(DP_STATION) sim/telegram.c
fieldling-dp_DEFAULTS = $(DP_DEFAULTS)

# The live demonstration: on a terminal until Ctrl-C.
.PHONY: run-dp
run-dp: build/posix/fieldling-master
	@$(if $(STATIONS),sh sim/run_stations.sh $(STATIONS),sh boards/posix/dp_demo.sh)
