# Static checks: every portable file on the 8051's and the Cortex-M0's compiler, the contexts of interrupt code,
# and the house rules that can be read off the text.

PORTABLE := $(sort $(wildcard firmware/*.c $(addsuffix /*.c,$(addprefix firmware/,phy_uart fdl ddlm modbus hdlc))))
HEADERS  := $(wildcard firmware/*.h firmware/*/*.h firmware/hal/blank/*.h boards/common/*.h)

# --nooverlay: SDCC would overlay the spilled temporaries of functions that call nothing, without asking whether one
# of them runs in an interrupt (host_tests/bad_samples/overlay.c).
# 110, 126: an `if` on a constant of the configuration; anything else it prints is a failure.
SDCC      := sdcc -mmcs51 --std-c11 --model-large --nooverlay --Werror --disable-warning 110 --disable-warning 126
ARM_CC    := arm-none-eabi-gcc -mcpu=cortex-m0 -mthumb -Os -std=c99 -Wall -Wextra -Wconversion -Werror
BLANK     := -Ifirmware -Ifirmware/hal/blank -Iboards/common \
             -DFIELDLING_CONFIG='"dp_test01.h"' -DMB_CONFIG='"inverter_mb.h"'
BLANK_RELS := $(patsubst %.c,build/blank/mcs51/%.rel,$(PORTABLE) firmware/hal/hal_blank.c)
BLANK_OBJS := $(patsubst %.c,build/blank/cortexm0/%.o,$(PORTABLE) firmware/hal/hal_blank.c)

build/blank/mcs51/%.rel: %.c $(HEADERS) host_tests/static.mk
	@mkdir -p $(@D)
	$(call say,SDCC,$@)out=$$($(SDCC) $(BLANK) -c $< -o $@ 2>&1) && test -z "$$out" || \
	    { echo "$$out"; rm -f $@; exit 1; }

build/blank/cortexm0/%.o: %.c $(HEADERS) host_tests/static.mk
	@mkdir -p $(@D)
	$(call say,ARM,$@)$(ARM_CC) $(BLANK) -c $< -o $@

STATIC += check-mcs51 check-cortexm0 check-sources

check-mcs51: $(sort $(BLANK_RELS) $(patsubst %.c,build/blank/mcs51/%.rel,$(BLANK_APPS)))
	@python3 host_tests/check_contexts.py $(^:.rel=.asm)

check-cortexm0: $(BLANK_OBJS)
	@:

# The bad samples break the rules on purpose, and the check names what it looks for.
check-sources:
	@python3 host_tests/check_sources.py $$(find Makefile README.md DESIGN.md .ci firmware boards sim gsd host_tests \
	    -type f ! -path '*/bad_samples/*' ! -path '*/__pycache__/*' ! -path '*/target/*' ! -name check_sources.py \
	    2>/dev/null)

# Each check rejects its bad sample.
export FIELDLING_SDCC := $(SDCC) $(BLANK)
QUICK_TESTS += host_tests/checks_reject.py host_tests/tidy_rules.py host_tests/tidy_random.py host_tests/near_rules.py
