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
	@if command -v openocd >/dev/null; then \
	    openocd -f interface/stlink.cfg -f target/stm32f1x.cfg -c "program $< 0x08000000 verify reset exit" || \
	        { echo "flash: OpenOCD found no ST-Link or no STM32F1 behind it (its words are above)" >&2; exit 1; }; \
	elif command -v st-flash >/dev/null; then \
	    st-flash --reset write $< 0x08000000 || \
	        { echo "flash: st-flash found no ST-Link or no STM32F1 behind it (its words are above)" >&2; exit 1; }; \
	else \
	    echo "flash: neither openocd nor st-flash is installed; the image is $<" >&2; exit 1; \
	fi
