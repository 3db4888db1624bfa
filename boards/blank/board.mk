# The empty port as images: the whole DP station and the whole Modbus server, linked for the 8051 and for a Cortex-M0.
# They show that nothing outside the port is missing, and what a stack costs before a board adds its own (make size).

BLANK_DP_APP     := boards/blank/main_dp.c boards/common/dp_test01_app.c
BLANK_DP_LIB      = $(DP_ALL)
BLANK_MODBUS_APP := boards/blank/main_modbus.c $(addprefix boards/common/inverter,.c _bind.c _modbus.c _store.c)
BLANK_MODBUS_LIB  = firmware/crc16.c firmware/crc16_append.c $(wildcard firmware/modbus/*.c)
BLANK_APPS       := $(BLANK_DP_APP) $(BLANK_MODBUS_APP) firmware/hal/hal_blank.c

define blank_images # NAME PREFIX
# SDCC's linker only warns about what is undefined; anything it says is a failure.
build/blank/$1.ihx: $$(patsubst %.c,build/blank/mcs51/%.rel,firmware/hal/hal_blank.c $$($2_APP) $$($2_LIB))
	@rm -f $$@ build/blank/$1.lib
	$$(call say,SDAR,build/blank/$1.lib)sdar -rcD build/blank/$1.lib \
	    $$(patsubst %.c,build/blank/mcs51/%.rel,$$($2_LIB)) >/dev/null
	$$(call say,SDLD,$$@)out=$$$$($$(SDCC) $$(patsubst %.c,build/blank/mcs51/%.rel,$$($2_APP) firmware/hal/hal_blank.c) \
	    build/blank/$1.lib -o $$@ 2>&1) && test -z "$$$$out" || { echo "$$$$out"; rm -f $$@; exit 1; }
build/blank/$1.elf: $$(patsubst %.c,build/blank/cortexm0/%.o,firmware/hal/hal_blank.c $$($2_APP) $$($2_LIB))
	@rm -f $$@ build/blank/$1.a
	$$(call say,AR,build/blank/$1.a)arm-none-eabi-ar rcsD build/blank/$1.a \
	    $$(patsubst %.c,build/blank/cortexm0/%.o,$$($2_LIB))
	$$(call say,LD,$$@)$$(ARM_CC) -nostartfiles --specs=nosys.specs -Wl,-e,main \
	    $$(patsubst %.c,build/blank/cortexm0/%.o,$$($2_APP) firmware/hal/hal_blank.c) build/blank/$1.a -o $$@
BOARD_IMAGES += build/blank/$1.ihx build/blank/$1.elf
BLANK_IMAGES += build/blank/$1.ihx build/blank/$1.elf
endef
$(eval $(call blank_images,dp,BLANK_DP))
$(eval $(call blank_images,modbus,BLANK_MODBUS))

STATIC += check-links
SIZES  += size-blank

check-links: $(BLANK_IMAGES)
	@:

size-blank: $(BLANK_IMAGES)
	@for s in dp modbus; do \
	    echo "$$s on the empty port, 8051 (internal RAM, external RAM, code):"; \
	    grep -A9 -E "^Stack starts|^Other memory" build/blank/$$s.mem; \
	done
	@echo "on the empty port, Cortex-M0:"
	@arm-none-eabi-size $(filter %.elf,$(BLANK_IMAGES))
