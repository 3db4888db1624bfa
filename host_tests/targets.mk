# The boards: the contract of the port on every machine, module tests in QEMU, images under foreign masters.

QEMU_BOARDS := com86 lm3s6965evb $(if $(rv32virt_TOOLS),rv32virt)
qemu_suffix  = $(if $(filter com86,$1),bin,elf)
TARGET_UNITY := -Ihost_tests/target/include -Ihost_tests/target -Ibuild/unity -DUNITY_INCLUDE_CONFIG_H

# ---- the contract of hal.h ---------------------------------------------------------------------------------------------

UNIT_TESTS += hal_contract
hal_contract_SRC    = host_tests/contract/virtual/peer.c $(HAL_VIRTUAL)
hal_contract_CFLAGS = -Ihost_tests -Ihost_tests/contract/virtual

com86_CONTRACT       := -DCONTRACT_LOOP=1 -DCONTRACT_NV=1
lm3s6965evb_CONTRACT := -DCONTRACT_LOOP=0 -DCONTRACT_NV=0
rv32virt_CONTRACT := -DCONTRACT_LOOP=1 -DCONTRACT_NV=1
$(foreach b,$(QEMU_BOARDS),$(eval $(call image,$b,hal_contract,\
    $($b_PORT) host_tests/hal_contract.c host_tests/target/console.c build/unity/unity.c,\
    $(TARGET_UNITY) -Ihost_tests -Ihost_tests/contract/board $($b_CONTRACT))))

# ---- the module tests, with the fake port of their own ------------------------------------------------------------------

define qemu_unit_test # BOARD,TEST
$(call image,$1,$2,$($1_START) host_tests/target/$1.c build/unity/unity.c \
    $(or $($2_MAIN),host_tests/$2.c) $($2_PORTABLE_SRC),\
    $(TARGET_UNITY) -I. -Ihost_tests $($2_PORTABLE_OPTIONS),$($2_PORTABLE_DEFAULTS),$($2_PORTABLE_SET))
endef
$(foreach b,$(QEMU_BOARDS),$(foreach t,$(PORTABLE_TESTS),$(eval $(call qemu_unit_test,$b,$t))))

$(foreach b,$(QEMU_BOARDS),$(eval $b_TESTS := $(patsubst %,build/$b/%.$(call qemu_suffix,$b),$(PORTABLE_TESTS) hal_contract)))
BOARD_IMAGES += $(foreach b,$(QEMU_BOARDS),$($b_TESTS))

# Which tests an image exists for.
build/qemu_tests: $(foreach b,$(QEMU_BOARDS),$($b_TESTS))
	@printf '%s\n' $^ >$@
BOARD_IMAGES += build/qemu_tests

SCRIPT_TESTS_ONCE += host_tests/qemu_units.py host_tests/qemu_dp.py host_tests/qemu_modbus.py
host_tests/qemu_units.py_TIMEOUT := 300
host_tests/qemu_dp.py_TIMEOUT    := 300
host_tests/qemu_modbus.py_TIMEOUT := 300

# ---- the F2808 on a model of its registers ---------------------------------------------------------------------------------

F2808_PORT = boards/f2808/board.c firmware/hal/f2808/machine.c firmware/hal/f2808/uart_sci.c firmware/hal/line_uart.c \
             sim/f2808_sci.c
F2808_CFLAGS = -Ihost_tests/contract/f2808 -Ifirmware/hal/f2808 -Iboards/f2808 -Ihost_tests

UNIT_TESTS += f2808_contract
f2808_contract_SRC    = host_tests/contract/f2808/peer.c $(F2808_PORT)
f2808_contract_CFLAGS = $(F2808_CFLAGS)

UNIT_TESTS += test_f2808
test_f2808_SRC    = boards/f2808/echo_back.c $(F2808_PORT)
test_f2808_CFLAGS = $(F2808_CFLAGS)

UNIT_TESTS += f2808_modbus
f2808_modbus_SRC      = $(filter-out boards/common/main_modbus.c boards/common/line_console.c,$(CONSOLE_MODBUS)) $(F2808_PORT)
f2808_modbus_DEFAULTS = $(MODBUS_DEFAULTS)
f2808_modbus_CFLAGS   = $(F2808_CFLAGS) -DMB_CONFIG='"inverter_mb.h"'

# The files of the part itself, which only a compiler for the C28x can translate: gcc reads them, in words of 32 bits.
STATIC += check-f2808
.PHONY: check-f2808
check-f2808:
	@gcc -m32 -std=c99 -ffreestanding -fsyntax-only -Wall -Wextra -Wconversion -Werror -include host_tests/c28x/ti.h \
	    -Ifirmware -Ifirmware/hal/f2808 -Ifirmware/hal/f2808/part -Iboards/f2808 -Iboards/common -I. \
	    $(wildcard firmware/hal/f2808/*.c firmware/hal/f2808/part/*.c boards/f2808/*.c) firmware/hal/line_uart.c
	@echo "f2808: the part's own files read"

# ---- make run BOARD=..., make flash BOARD=... --------------------------------------------------------------------------------

.PHONY: flash-which-board
run-board-%: build/posix/fieldling-master
	@$(MAKE) --no-print-directory build/$*/fieldling-dp.$(call qemu_suffix,$*)
	@python3 host_tests/run_board.py $*

flash-which-board:
	@echo "make flash BOARD=bluepill, 87c51fb or stc89c58rd" >&2; exit 1

SCRIPT_TESTS_ONCE += host_tests/flash.py

# ---- what a station takes without board and application -----------------------------------------------------------------

# The stack and the defaults of its callbacks as objects, before linking: what an application does not call is counted too;
# the port, libgcc and mem*() are not. Buffers are those of DP-TEST01 (dp_test01.h) and of the inverter (inverter_mb.h).
STACK_CPUS     := cortex-m0 cortex-m3
STACK_dp       := $(DP_ALL)
STACK_dp_OPTIONS     := -DFIELDLING_CONFIG='"dp_test01.h"'
STACK_modbus   := firmware/crc16.c firmware/crc16_append.c $(wildcard firmware/modbus/*.c)
STACK_modbus_OPTIONS := -DMB_CONFIG='"inverter_mb.h"'
define stack_objects # CPU,STACK
stack-$1_CC := $(subst -mcpu=cortex-m3,-mcpu=$1,$(lm3s6965evb_CC))
$(call image_set,stack-$1,$2,$(STACK_$2_OPTIONS))
STACK_OBJECTS_$1_$2 := $(call image_objects,stack-$1,$2,$(STACK_$2))
STACK_OBJECTS += $(call image_objects,stack-$1,$2,$(STACK_$2))
endef
$(foreach c,$(STACK_CPUS),$(foreach s,dp modbus,$(eval $(call stack_objects,$c,$s))))

.PHONY: bench-stack
BENCHES += bench-stack
bench-stack: $(STACK_OBJECTS)
	@echo "The stack alone, -Os, before linking, without port and application; .text with constants:"
	@printf '  %-10s %-8s %7s %7s %7s\n' "" "" .text .data .bss
	@$(foreach c,$(STACK_CPUS),$(foreach s,dp modbus,arm-none-eabi-size -t $(STACK_OBJECTS_$c_$s) | \
	    awk '/TOTALS/ { printf "  %-10s %-8s %7d %7d %7d\n", "$c", "$s", $$1, $$2, $$3 }';))

# ---- what the boards take --------------------------------------------------------------------------------------------------------

GCC_IMAGES := $(foreach i,fieldling-dp fieldling-modbus,build/com86/$i.bin build/lm3s6965evb/$i.elf build/bluepill/$i.bin \
    $(if $(rv32virt_TOOLS),build/rv32virt/$i.elf))
SCRIPT_TESTS_ONCE += host_tests/budget.py
host_tests/budget.py_TIMEOUT := 300
SIZES   += size-boards
BENCHES += bench-boards
size-boards: $(GCC_IMAGES)
	@python3 host_tests/budget.py
bench-boards: $(GCC_IMAGES)
	@arm-none-eabi-size build/lm3s6965evb/fieldling-*.elf build/bluepill/fieldling-*.elf
	@python3 host_tests/budget.py --table
