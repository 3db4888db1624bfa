#!/bin/sh
# make run: DP-TEST01 and a DP master on a simulated RS-485 segment, live. On a terminal until Ctrl-C or "quit";
# elsewhere 10 s, a summary line, and status 0 if data exchange was reached and no rule of the line broken.
#
# usage: boards/posix/dp_demo.sh [OPTIONS of fieldling-master]
set -eu
[ -t 1 ] || set -- --seconds 10 "$@"
exec "${FIELDLING_BIN:-build/posix}/fieldling-master" --line sim:8 --rate 93750 --cycle 0 --count "$@" \
    cyclic boards/posix/dp_demo.conf
