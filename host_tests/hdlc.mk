# HDLC: the wire, the chip model, the driver, the secondary, the remote modules and their master station.

HDLC_ALL      := $(sort $(wildcard firmware/hdlc/*.c))
HDLC_DEFAULTS := $(filter %_default.c,$(HDLC_ALL))
HDLC_SRC      := $(filter-out $(HDLC_DEFAULTS),$(HDLC_ALL))

# The modelled chip, as a program's port sees it; the station on one line of bits in virtual time.
HDLC_CHIP = firmware/hal/posix/hal_8273_model.c sim/i8273.c sim/i8273_line.c sim/hdlc_bits.c
HDLC_BUS  = $(HDLC_CHIP) $(HAL_VIRTUAL) sim/hdlc_bus.c host_tests/hdlc_no_uart.c

UNIT_TESTS += test_hdlc_bits
test_hdlc_bits_SRC = sim/hdlc_bits.c

UNIT_TESTS += test_hdlc_nrm
test_hdlc_nrm_SRC      = $(HDLC_SRC) $(HDLC_BUS)
test_hdlc_nrm_DEFAULTS = $(HDLC_DEFAULTS)
