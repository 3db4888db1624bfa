# The host as a board: stations in real time over a pseudo terminal or a serial port.

# The port in real time, and what every host station shares: prog_SRC = $(HOST_STATION) ...
HAL_REALTIME = $(addprefix firmware/hal/posix/,hal_realtime.c line_pty.c line_tty.c nv_file.c con_stdio.c)
HOST_STATION = $(HAL_REALTIME) boards/posix/options.c boards/posix/console.c
