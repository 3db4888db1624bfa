# LM3S6965 evaluation board (Cortex-M3), run in qemu-system-arm.

$(eval $(call cortexm_board,lm3s6965evb,cortex-m3,pl011))
$(eval $(call image,lm3s6965evb,fieldling-dp,$(lm3s6965evb_PORT) $(CONSOLE_DP),-DFIELDLING_CONFIG='"dp_test01.h"',$(DP_DEFAULTS)))

BOARD_IMAGES += build/lm3s6965evb/fieldling-dp.elf
