#!/bin/sh
# usage: flash.sh IMAGE.bin PORT    over the part's own boot loader, on the serial port (P3.0, P3.1, not through the RS-485
#                                   transceiver), with stcgal; then switch the part off and on
set -u
stcgal=$(command -v stcgal || command -v build/venv/bin/stcgal) || {
    echo "flash: stcgal is not installed (build/venv/bin/pip install stcgal==1.10); the image is $1" >&2
    exit 1
}
[ -e "$2" ] || {
    echo "flash: there is no serial port $2 (make flash BOARD=stc89c58rd PORT=/dev/...)" >&2
    exit 1
}
# 12 clocks a cycle; full gain for the 24 MHz crystal; ALE for the bus; the data flash keeps the station's address.
"$stcgal" -P stc89 -p "$2" -o cpu_6t_enabled=false -o clock_gain=high -o ale_enabled=true -o xram_enabled=true \
    -o watchdog_por_enabled=false -o eeprom_erase_enabled=false "$1" || {
    echo "flash: stcgal could not program the part on $2 (its words are above)" >&2
    exit 1
}
