# QEMU's RISC-V machine "virt", 32 bits. Left out where its compiler or simulator is not installed.

rv32virt_TOOLS := $(and $(shell command -v riscv64-unknown-elf-gcc),$(shell command -v qemu-system-riscv32))

rv32virt_CC = riscv64-unknown-elf-gcc -march=rv32imac_zicsr -mabi=ilp32 -mcmodel=medany -Os -std=gnu99 -ffreestanding \
              -ffunction-sections -fdata-sections -Wall -Wextra -Wconversion -Werror -msmall-data-limit=0 \
              -Ifirmware -Ifirmware/hal/riscv -Ifirmware/hal/riscv/ns16550 -Iboards/rv32virt -Iboards/common
rv32virt_SCRIPT = boards/rv32virt/board.ld
rv32virt_LD = -nostdlib -Wl,--build-id=none,--gc-sections,--no-warn-rwx-segments,-T,boards/rv32virt/board.ld -lgcc
rv32virt_START = firmware/hal/riscv/start.S
rv32virt_PORT = $(rv32virt_START) boards/rv32virt/board.c firmware/hal/riscv/core.c \
                $(addprefix firmware/hal/,line_uart.c nv_log.c con_in.c) $(wildcard firmware/hal/riscv/ns16550/*.c)

$(eval $(call dp_image,rv32virt))
$(eval $(call modbus_image,rv32virt))

BOARD_IMAGES += $(if $(rv32virt_TOOLS),build/rv32virt/fieldling-dp.elf build/rv32virt/fieldling-modbus.elf)
