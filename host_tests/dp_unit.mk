# Unit tests of the DP stack, module by module, on a machine without time (fake_hal.c).

DP_UNIT_TESTS := test_bytes test_phy_uart test_fdl_rx
UNIT_TESTS += $(DP_UNIT_TESTS)

UNIT_PHY  := host_tests/fake_hal.c firmware/phy_uart/phy_uart.c
UNIT_FDL  := $(UNIT_PHY) $(addprefix firmware/fdl/,fdl.c fdl_rx.c fdl_tx.c fdl_sap.c)
UNIT_FMA  := $(UNIT_FDL) firmware/fdl/fma.c

test_bytes_SRC    :=
test_phy_uart_SRC := $(UNIT_PHY)
test_fdl_rx_SRC   := $(UNIT_PHY) firmware/fdl/fdl_rx.c

# Their devices; host_tests/config says what is special about each.
$(foreach t,$(DP_UNIT_TESTS),$(eval $(t)_CONFIG ?= host_tests/config/unit_dp.h))
