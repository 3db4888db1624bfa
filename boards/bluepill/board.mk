# STM32F103C8 "Blue Pill" (Cortex-M3).

$(eval $(call cortexm_board,bluepill,cortex-m3,stm32f1))
$(eval $(call dp_image,bluepill))
$(eval $(call modbus_image,bluepill))

build/bluepill/%.bin: build/bluepill/%.elf
	@arm-none-eabi-objcopy -O binary --remove-section=.nv $< $@

BOARD_IMAGES += build/bluepill/fieldling-dp.bin build/bluepill/fieldling-modbus.bin

# Over an ST-Link, with OpenOCD or st-flash, whichever is there: make flash BOARD=bluepill IMAGE=fieldling-modbus
IMAGE ?= fieldling-dp
.PHONY: flash-bluepill
flash-bluepill: build/bluepill/$(IMAGE).bin
	@sh boards/bluepill/flash.sh $<
