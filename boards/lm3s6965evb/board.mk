# LM3S6965 evaluation board (Cortex-M3), run in qemu-system-arm.

$(eval $(call cortexm_board,lm3s6965evb,cortex-m3,pl011))
$(eval $(call dp_image,lm3s6965evb))
$(eval $(call modbus_image,lm3s6965evb))

BOARD_IMAGES += build/lm3s6965evb/fieldling-dp.elf build/lm3s6965evb/fieldling-modbus.elf
