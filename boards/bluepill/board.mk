# STM32F103C8 "Blue Pill" (Cortex-M3).

$(eval $(call cortexm_board,bluepill,cortex-m3,stm32f1))
$(eval $(call image,bluepill,fieldling-dp,$(bluepill_PORT) $(CONSOLE_DP),-DFIELDLING_CONFIG='"dp_test01.h"',$(DP_DEFAULTS)))

build/bluepill/%.bin: build/bluepill/%.elf
	@arm-none-eabi-objcopy -O binary --remove-section=.nv $< $@

BOARD_IMAGES += build/bluepill/fieldling-dp.bin
