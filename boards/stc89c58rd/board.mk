# STC89C58RD+ in 12-clock mode: 32 kB of flash, 1 kB of RAM on the chip, or 32 kB outside. See README.md.
include firmware/hal/mcs51/image.mk

STC_FOSC ?= 24000000
stc89c58rd_CONFIG := dp_test01.h
stc89c58rd_CFLAGS := -DFOSC_HZ=$(STC_FOSC)ul
stc89c58rd_CODE   := 0x8000
stc89c58rd_HAL    := $(addprefix firmware/hal/mcs51/,machine.c serial.c silence.c con_none.c) boards/stc89c58rd/data_flash.c

stc89c58rd/fieldling-dp_SRC      := boards/common/main_mcs51_dp.c boards/stc89c58rd/with_ram.c $(stc89c58rd_HAL) firmware/hal/mcs51/chunk.c $(filter-out %/fma_watch.c,$(DP_STATION)) boards/common/no_fma_watch.c
stc89c58rd/fieldling-dp_DEFAULTS := $(DP_DEFAULTS)
stc89c58rd/fieldling-dp_XRAM     := 0x8000
$(eval $(call mcs51_image,stc89c58rd,fieldling-dp))

# The linker refuses an address outside the RAM on the chip.
stc89c58rd/fieldling-modbus_SRC      := boards/common/main_mcs51_modbus.c boards/stc89c58rd/alone.c $(stc89c58rd_HAL) $(filter-out %/mb_file.c,$(MCS51_MODBUS))
stc89c58rd/fieldling-modbus_DEFAULTS := $(MODBUS_DEFAULTS)
stc89c58rd/fieldling-modbus_CFLAGS    = $(MCS51_MODBUS_CFLAGS) -UMB_CONFIG -DMB_CONFIG='"inverter_small.h"' -DINV_TREND_KEPT=2u
stc89c58rd/fieldling-modbus_XRAM     := 0x400
$(eval $(call mcs51_image,stc89c58rd,fieldling-modbus))

# make flash BOARD=stc89c58rd PORT=/dev/ttyUSB0 IMAGE=fieldling-modbus
.PHONY: flash-stc89c58rd
PORT  ?= /dev/ttyUSB0
IMAGE ?= fieldling-dp
flash-stc89c58rd: build/stc89c58rd/$(IMAGE).bin
	@sh boards/stc89c58rd/flash.sh $< $(PORT)
