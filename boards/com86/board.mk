# COM86: a 64 kB ROM image for a 386EX-class board, run in qemu-system-i386.

COM86_CC = gcc -m32 -march=i386 -Os -std=gnu99 -ffreestanding -fno-pic -fno-stack-protector \
           -fno-asynchronous-unwind-tables -mno-sse -mno-mmx -ffunction-sections -fdata-sections \
           -Wall -Wextra -Wconversion -Werror -Ifirmware -Ifirmware/hal/x86 -Iboards/com86 -Iboards/common
COM86_LD = -nostdlib -static -no-pie -Wl,--build-id=none,--gc-sections,--no-warn-rwx-segments,-T,boards/com86/rom.ld,-Map,$(@:.elf=.map)

COM86_PORT = $(addprefix boards/com86/,start.S board.c) firmware/hal/line_uart.c firmware/hal/nv_log.c $(wildcard firmware/hal/x86/*.c)
COM86_DP   = $(COM86_PORT) boards/com86/main_dp.c boards/common/dp_console.c $(DP_STATION)

build/com86/dp/%.o: %.c
	@mkdir -p $(@D)
	$(call say,CC86,$@)$(COM86_CC) -DFIELDLING_CONFIG='"dp_test01.h"' -MMD -MP -c $< -o $@
build/com86/dp/%.o: %.S
	@mkdir -p $(@D)
	$(call say,AS86,$@)$(COM86_CC) -c $< -o $@

com86_objects = $(patsubst %.c,build/com86/$1/%.o,$(patsubst %.S,build/com86/$1/%.o,$2))

build/com86/fieldling-dp.elf: $(call com86_objects,dp,$(COM86_DP)) build/com86/dp/defaults.a boards/com86/rom.ld
	$(call say,LD86,$@)$(COM86_CC) $(filter %.o %.a,$^) $(COM86_LD) -o $@
build/com86/dp/defaults.a: $(call com86_objects,dp,$(DP_DEFAULTS))
	$(call say,AR86,$@)rm -f $@ && ar rcs $@ $^
# exactly 64 kB: what is not written reads as erased flash
build/com86/%.bin: build/com86/%.elf
	@objcopy -O binary --gap-fill 0xFF --pad-to 0x100000 $< $@ && test $$(stat -c %s $@) = 65536
-include $(patsubst %.o,%.d,$(filter %.o,$(call com86_objects,dp,$(COM86_DP))))

BOARD_IMAGES += build/com86/fieldling-dp.bin
