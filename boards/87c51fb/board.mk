# The 87C51FB board: 16 kB of EPROM, 32 kB of battery-backed RAM (the last 32 octets are the non-volatile ones).
include firmware/hal/mcs51/image.mk

FOSC ?= 12000000
87c51fb_CONFIG := dp_test01.h
87c51fb_CFLAGS := -DFOSC_HZ=$(FOSC)ul
87c51fb_CODE   := 0x4000
87c51fb_XRAM   := 0x7FE0
87c51fb_HAL    := $(addprefix firmware/hal/mcs51/,machine.c serial.c silence.c nv_ram.c con_none.c)

87c51fb/fieldling-dp_SRC      := boards/common/main_mcs51_dp.c boards/87c51fb/board.c $(87c51fb_HAL) firmware/hal/mcs51/chunk.c $(filter-out %/fma_watch.c,$(DP_STATION)) boards/common/no_fma_watch.c
87c51fb/fieldling-dp_DEFAULTS := $(DP_DEFAULTS)
$(eval $(call mcs51_image,87c51fb,fieldling-dp))

87c51fb/fieldling-modbus_SRC      := boards/common/main_mcs51_modbus.c boards/87c51fb/board.c $(87c51fb_HAL) $(MCS51_MODBUS)
87c51fb/fieldling-modbus_DEFAULTS := $(MODBUS_DEFAULTS)
87c51fb/fieldling-modbus_CFLAGS   := $(MCS51_MODBUS_CFLAGS)
$(eval $(call mcs51_image,87c51fb,fieldling-modbus))

# make flash BOARD=87c51fb DEVICE=AT89C55WD IMAGE=fieldling-modbus: an 8052 with 20 kB of flash in the 87C51FB's socket
.PHONY: flash-87c51fb
IMAGE  ?= fieldling-dp
DEVICE ?= AT89C55WD
flash-87c51fb: build/87c51fb/$(IMAGE).bin
	@sh boards/87c51fb/flash.sh $< $(DEVICE)
