#!/bin/sh
# usage: flash.sh IMAGE.bin    programs the flash from its start, over an ST-Link, with the tool that is installed
set -u
failed() { # TOOL
    echo "flash: $1 found no ST-Link or no STM32F1 behind it (its words are above)" >&2
    exit 1
}

if command -v openocd >/dev/null; then
    openocd -f interface/stlink.cfg -f target/stm32f1x.cfg -c "program $1 0x08000000 verify reset exit" || failed OpenOCD
elif command -v st-flash >/dev/null; then
    st-flash --reset write "$1" 0x08000000 || failed st-flash
else
    echo "flash: neither openocd nor st-flash is installed (packages openocd, stlink-tools); the image is $1" >&2
    exit 1
fi
