# COM86: a 64 kB ROM image for a 386EX-class board, run in qemu-system-i386.

com86_CC = gcc -m32 -march=i386 -Os -std=gnu99 -ffreestanding -fno-pic -fno-stack-protector \
           -fno-asynchronous-unwind-tables -mno-sse -mno-mmx -ffunction-sections -fdata-sections \
           -Wall -Wextra -Wconversion -Werror -Ifirmware -Ifirmware/hal/x86 -Iboards/com86 -Iboards/common
com86_SCRIPT = boards/com86/rom.ld
com86_LD = -nostdlib -static -no-pie -Wl,--build-id=none,--gc-sections,--no-warn-rwx-segments,-T,boards/com86/rom.ld
com86_START = boards/com86/start.S
com86_PORT = $(com86_START) boards/com86/board.c $(addprefix firmware/hal/,line_uart.c nv_log.c con_in.c) \
             $(wildcard firmware/hal/x86/*.c)

$(eval $(call dp_image,com86))
$(eval $(call modbus_image,com86))

# exactly 64 kB: what is not written reads as erased flash
build/com86/%.bin: build/com86/%.elf
	@objcopy -O binary --gap-fill 0xFF --pad-to 0x100000 $< $@ && test $$(stat -c %s $@) = 65536

BOARD_IMAGES += build/com86/fieldling-dp.bin build/com86/fieldling-modbus.bin
