# How a firmware image of a gcc board is built. A board says, with its own name as prefix,
#   X_CC       compiler and options      X_LD  options for linking      X_SCRIPT  linker scripts it depends on
# and asks with $(eval $(call image,X,NAME,SOURCES,OPTIONS,DEFAULTS)) for build/X/NAME.elf; OPTIONS choose the configuration,
# DEFAULTS are the optional callbacks' defaults, linked from an archive.

define image
$1_$2_objects := $(patsubst %.c,build/$1/$2/%.o,$(patsubst %.S,build/$1/$2/%.o,$3))
$1_$2_defaults := $(patsubst %.c,build/$1/$2/%.o,$5 boards/common/mem.c)
build/$1/$2/%.o: %.c
	@mkdir -p $$(@D)
	$$(call say,CC,$$@)$$($1_CC) $4 -MMD -MP -c $$< -o $$@
build/$1/$2/%.o: %.S
	@mkdir -p $$(@D)
	$$(call say,AS,$$@)$$($1_CC) -c $$< -o $$@
build/$1/$2/defaults.a: $$($1_$2_defaults)
	$$(call say,AR,$$@)rm -f $$@ && ar rcs $$@ $$^
build/$1/$2.elf: $$($1_$2_objects) build/$1/$2/defaults.a $($1_SCRIPT)
	$$(call say,LD,$$@)$$($1_CC) $$(filter %.o %.a,$$^) $$($1_LD) -Wl,-Map,$$(@:.elf=.map) -o $$@
-include $$($1_$2_objects:.o=.d) $$($1_$2_defaults:.o=.d)
endef

# $(eval $(call cortexm_board,X,CPU,UART)): the options of a Cortex-M board with a linker script board.ld; UART is a folder
# of firmware/hal/cortexm. X_PORT are its sources.
define cortexm_board
$1_CC = arm-none-eabi-gcc -mcpu=$2 -mthumb -Os -std=gnu99 -ffreestanding -ffunction-sections -fdata-sections \
        -Wall -Wextra -Wconversion -Werror -Ifirmware -Ifirmware/hal/cortexm -Ifirmware/hal/cortexm/$3 -Iboards/$1 \
        -Iboards/common
$1_SCRIPT = boards/$1/board.ld firmware/hal/cortexm/flash.ld
$1_LD = -nostdlib -Wl,--gc-sections,--no-warn-rwx-segments,-T,boards/$1/board.ld -lgcc
$1_PORT = boards/$1/board.c firmware/hal/cortexm/core.c $$(addprefix firmware/hal/,line_uart.c nv_log.c con_in.c) \
          $$(wildcard firmware/hal/cortexm/$3/*.c)
endef
