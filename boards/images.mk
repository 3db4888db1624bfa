# How a firmware image of a gcc board is built. A board says, with its own name as prefix,
#   X_CC       compiler and options      X_LD  options for linking      X_SCRIPT  linker scripts it depends on
# and asks for build/X/NAME.elf with
#   $(eval $(call image,X,NAME,SOURCES,OPTIONS,DEFAULTS,SET))
# OPTIONS choose the configuration; DEFAULTS are the optional callbacks' defaults, linked from an archive. Images of the
# same SET, which must have the same OPTIONS, share objects; without SET an image has its own.

define image_set # X,SET,OPTIONS
build/$1/obj/$2/%.o: %.c
	@mkdir -p $$(@D)
	$$(call say,CC,$$@)$$($1_CC) $$(if $$(findstring build/unity,$$<),-w) $3 -MMD -MP -c $$< -o $$@
build/$1/obj/$2/%.o: %.S
	@mkdir -p $$(@D)
	$$(call say,AS,$$@)$$($1_CC) -c $$< -o $$@
image_set_$1_$2 := 1
endef

define image_link # X,NAME,OBJECTS,DEFAULTS
build/$1/obj/$2.a: $4
	$$(call say,AR,$$@)rm -f $$@ && ar rcs $$@ $$^
build/$1/$2.elf: $3 build/$1/obj/$2.a $($1_SCRIPT)
	$$(call say,LD,$$@)$$($1_CC) $$(filter %.o %.a,$$^) $$($1_LD) -Wl,-Map,$$(@:.elf=.map) -o $$@
-include $(patsubst %.o,%.d,$3 $4)
endef

image_objects = $(patsubst %.c,build/$1/obj/$2/%.o,$(patsubst %.S,build/$1/obj/$2/%.o,$3))
define image
$(if $(image_set_$1_$(or $6,$2)),,$(eval $(call image_set,$1,$(or $6,$2),$4)))
$(call image_link,$1,$2,$(call image_objects,$1,$(or $6,$2),$3),$(call image_objects,$1,$(or $6,$2),$5 boards/common/mem.c))
endef

# $(eval $(call dp_image,X)), $(eval $(call modbus_image,X)): the two reference applications on board X.
dp_image     = $(call image,$1,fieldling-dp,$($1_PORT) $(CONSOLE_DP),-DFIELDLING_CONFIG='"dp_test01.h"',$(DP_DEFAULTS))
modbus_image = $(call image,$1,fieldling-modbus,$($1_PORT) $(CONSOLE_MODBUS),-DMB_CONFIG='"inverter_mb.h"',$(MODBUS_DEFAULTS))

CONSOLE_MODBUS  = boards/common/main_modbus.c boards/common/line_console.c $(addprefix boards/common/inverter,.c _bind.c _store.c _modbus.c) \
                   firmware/crc16.c firmware/crc16_append.c $(wildcard firmware/modbus/mb_*.c)
MODBUS_DEFAULTS = $(wildcard firmware/modbus/default_*.c)

# $(eval $(call cortexm_board,X,CPU,UART)): the options of a Cortex-M board with a linker script board.ld; UART is a folder
# of firmware/hal/cortexm. X_START is what runs before main(), X_PORT all the sources of its port.
define cortexm_board
$1_CC = arm-none-eabi-gcc -mcpu=$2 -mthumb -Os -std=gnu99 -ffreestanding -ffunction-sections -fdata-sections \
        -Wall -Wextra -Wconversion -Werror -Ifirmware -Ifirmware/hal/cortexm -Ifirmware/hal/cortexm/$3 -Iboards/$1 \
        -Iboards/common
$1_SCRIPT = boards/$1/board.ld firmware/hal/cortexm/flash.ld
$1_LD = -nostdlib -Wl,--gc-sections,--no-warn-rwx-segments,-T,boards/$1/board.ld -lgcc
$1_START = firmware/hal/cortexm/start.c
$1_PORT = $$($1_START) boards/$1/board.c firmware/hal/cortexm/core.c \
          $$(addprefix firmware/hal/,line_uart.c nv_log.c con_in.c) $$(wildcard firmware/hal/cortexm/$3/*.c)
endef
