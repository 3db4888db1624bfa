# 8051 images in the simulator s51, and their budgets.

SCRIPT_TESTS_ONCE += host_tests/s51_dp.py host_tests/s51_masters.py host_tests/s51_contract.py host_tests/s51_states.py \
                     host_tests/s51_faults.py
host_tests/s51_contract.py_TIMEOUT := 300
host_tests/s51_dp.py_TIMEOUT      := 300
host_tests/s51_masters.py_TIMEOUT := 300
host_tests/s51_states.py_TIMEOUT  := 300
host_tests/s51_faults.py_TIMEOUT  := 300
SCRIPT_TESTS_ONCE += host_tests/s51_stc89.py
host_tests/s51_stc89.py_TIMEOUT := 300
LONG_TESTS += host_tests/s51_long.py host_tests/s51_stc89_long.py
host_tests/s51_stc89_long.py_TIMEOUT := 3600
host_tests/s51_long.py_TIMEOUT := 21600

# The DP image for a 24 MHz crystal, which has 19.2 kbit/s.
87c51fb/fieldling-dp-24mhz_SRC      = $(87c51fb/fieldling-dp_SRC)
87c51fb/fieldling-dp-24mhz_DEFAULTS = $(87c51fb/fieldling-dp_DEFAULTS)
87c51fb/fieldling-dp-24mhz_CFLAGS  := -UFOSC_HZ -DFOSC_HZ=24000000ul
$(eval $(call mcs51_image,87c51fb,fieldling-dp-24mhz))

# The Modbus image for an 11.0592 MHz crystal, which has every rate, 19200 among them.
87c51fb/fieldling-modbus-11059_SRC      = $(87c51fb/fieldling-modbus_SRC)
87c51fb/fieldling-modbus-11059_DEFAULTS = $(87c51fb/fieldling-modbus_DEFAULTS)
87c51fb/fieldling-modbus-11059_CFLAGS   = $(MCS51_MODBUS_CFLAGS) -UFOSC_HZ -DFOSC_HZ=11059200ul
$(eval $(call mcs51_image,87c51fb,fieldling-modbus-11059))

SCRIPT_TESTS_ONCE += host_tests/s51_modbus.py host_tests/s51_libmodbus.py
host_tests/s51_modbus.py_TIMEOUT    := 300
host_tests/s51_libmodbus.py_TIMEOUT := 300
BENCHES += bench-s51-modbus
bench-s51-modbus: build/87c51fb/fieldling-modbus.ihx build/87c51fb/fieldling-modbus-11059.ihx
	@echo "The Modbus inverter on a 12 and an 11.0592 MHz 87C51FB, simulated machine cycles:"
	@$(PYTHON) host_tests/s51_modbus.py | grep -v Tests

BENCHES += bench-s51
bench-s51: build/87c51fb/fieldling-dp.ihx
	@echo "DP-TEST01 on a 12 MHz 87C51FB, simulated machine cycles:"
	@python3 host_tests/s51_dp.py --figures

run-board-87c51fb: build/posix/fieldling-master build/87c51fb/fieldling-$(PROTOCOL).ihx
	@python3 host_tests/run_board.py 87c51fb 10 $(PROTOCOL)

# make size and make check: every image that image.mk builds keeps interrupts apart and is within its board's budget.txt.
# What went into build/BOARD/IMAGE.ihx lies in the folder build/BOARD/IMAGE.
SIZES  += size-mcs51
STATIC += size-mcs51 check-mcs51-images
.SECONDEXPANSION:
size-mcs51: $$(MCS51_IMAGES)
	@python3 host_tests/mcs51_size.py $(MCS51_IMAGES)
check-mcs51-images: $$(MCS51_IMAGES)
	@for image in $(MCS51_IMAGES:.ihx=); do \
	    python3 host_tests/check_contexts.py $$(find $$image -name '*.asm') || exit 1; \
	done
	@python3 host_tests/check_image.py $(MCS51_IMAGES)

# ---- the contract of hal.h, compiled as the product is; a constant condition is no mistake in a test (126) ----

S51_CONTRACT_SRC := host_tests/hal_contract.c host_tests/contract/s51/unity.c $(87c51fb_HAL) firmware/hal/mcs51/octet.c
S51_CONTRACT_REL := $(patsubst %.c,build/s51_contract/%.rel,$(S51_CONTRACT_SRC))
S51_CONTRACT_CC   = $(MCS51_CC) --disable-warning 126 -Ihost_tests/contract/s51 -Ihost_tests $(MCS51_INCLUDES) \
                    -Iboards/87c51fb -DFOSC_HZ=12000000ul

BOARD_IMAGES += build/s51_contract/hal_contract.ihx
build/s51_contract/%.rel: %.c $(wildcard firmware/*.h firmware/hal/*.h firmware/hal/mcs51/*.h host_tests/contract/s51/*.h) \
                          host_tests/hal_contract.h boards/87c51fb/wiring.h host_tests/mcs51.mk
	@mkdir -p $(@D)
	$(call say,SDCC,$@)$(S51_CONTRACT_CC) -c $< -o $@
build/s51_contract/hal_contract.ihx: $(S51_CONTRACT_REL)
	$(call say,LINK51,$@)$(S51_CONTRACT_CC) --code-size $(87c51fb_CODE) --xram-size $(87c51fb_XRAM) --iram-size 256 $^ -o $@
