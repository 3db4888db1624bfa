# The module tests on the simulated 8051: the same sources and assertions as on the host.
#
# Unity in the large model wants more internal RAM than there is, so these images keep locals on the stack (--stack-auto)
# and have one register bank: the code generation differs from the product's, which s51_dp.py and s51_contract.py run.

S51_UNIT_CC := sdcc -mmcs51 --std-c11 --model-large --stack-auto --disable-warning 85 --disable-warning 110 \
    --disable-warning 126 -DIN_ISR= -DUNITY_INCLUDE_CONFIG_H -Ihost_tests/s51 -Ibuild/unity -I. -Ifirmware \
    -Ifirmware/hal/mcs51 -Ihost_tests -Iboards/common
S51_UNIT_HEADERS := $(HEADERS) $(wildcard host_tests/*.h host_tests/config/*.h host_tests/s51/*.h)

# $(call s51_unit_set,SET,OPTIONS): objects of one device
define s51_unit_set
build/s51_units/$1/host_tests/test_%.rel: host_tests/test_%.c $(S51_UNIT_HEADERS)
	@mkdir -p $$(@D)
	$$(call say,SDCC,$$@)$(S51_UNIT_CC) -Dmain=test_main $2 -c $$< -o $$@
build/s51_units/$1/%.rel: %.c $(S51_UNIT_HEADERS)
	@mkdir -p $$(@D)
	$$(call say,SDCC,$$@)$(S51_UNIT_CC) $2 -c $$< -o $$@
s51_unit_set_$1 := 1
endef

# $(call s51_unit,TEST,SET)
define s51_unit
$(if $(s51_unit_set_$2),,$(eval $(call s51_unit_set,$2,$($1_PORTABLE_OPTIONS))))
build/s51_units/$1.lib: $(patsubst %.c,build/s51_units/$2/%.rel,$($1_PORTABLE_DEFAULTS))
	@rm -f $$@ && sdar -rc $$@ $$^
build/s51_units/$1.ihx: $(patsubst %.c,build/s51_units/$2/%.rel,build/unity/unity.c host_tests/s51/unit_main.c \
    $(or $($1_MAIN),host_tests/$1.c) $($1_PORTABLE_SRC:$($1_S51_NOT)=$($1_S51))) $(if $($1_PORTABLE_DEFAULTS),build/s51_units/$1.lib)
	$$(call say,LD51,$$@)sdcc -mmcs51 --model-large --stack-auto $$(filter %.rel,$$^) $$(filter %.lib,$$^) -o $$@
build/s51_units/$1.map: build/s51_units/$1.ihx ;
BOARD_IMAGES += build/s51_units/$1.map
endef
# What the port of the 8051 has of its own.
test_crc16_octets_S51_NOT := firmware/crc16_append.c
test_crc16_octets_S51     := firmware/hal/mcs51/crc16_append.c

# Not here, for they take minutes to simulate: 340 s of an inverter's drive, 70000 samples, and cells in the flash of 32-bit
# parts, page by page.
S51_PORTABLE := $(filter-out test_modbus_inverter test_remote_wrap test_nv_log,$(PORTABLE_TESTS))
$(foreach t,$(S51_PORTABLE),$(eval $(call s51_unit,$t,$($t_PORTABLE_SET))))

# Which tests an image exists for.
build/s51_units/images: $(patsubst %,build/s51_units/%.map,$(S51_PORTABLE))
	@printf '%s\n' $(patsubst %,build/s51_units/%.ihx,$(S51_PORTABLE)) >$@
BOARD_IMAGES += build/s51_units/images

SCRIPT_TESTS_ONCE += host_tests/s51_units.py
host_tests/s51_units.py_TIMEOUT := 400
