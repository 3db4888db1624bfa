# Unit tests of the DP stack, module by module, on a machine without time (fake_hal.c).

DP_UNIT_TESTS := test_bytes test_phy_uart test_fdl_rx test_fdl_tx test_fdl_services test_fdl_retry test_fdl_sap \
    test_fdl_small test_fma
UNIT_TESTS += $(DP_UNIT_TESTS)

UNIT_PHY := host_tests/fake_hal.c firmware/phy_uart/phy_uart.c
UNIT_FDL := $(UNIT_PHY) $(addprefix firmware/fdl/,fdl.c fdl_rx.c fdl_tx.c fdl_sap.c fma.c) host_tests/fdl_unit.c

test_phy_uart_SRC := $(UNIT_PHY)
test_fdl_rx_SRC   := $(UNIT_PHY) firmware/fdl/fdl_rx.c
test_fdl_tx_SRC   := host_tests/fake_hal.c firmware/fdl/fdl_tx.c firmware/fdl/fdl_sap.c
$(foreach t,test_fdl_services test_fdl_retry test_fdl_sap test_fdl_small test_fma,$(eval $(t)_SRC := $(UNIT_FDL))\
    $(eval $(t)_DEFAULTS := firmware/fdl/fma_event_default.c))

# Their devices; host_tests/config says what is special about each.
test_fdl_small_CONFIG := host_tests/config/unit_small.h
$(foreach t,$(DP_UNIT_TESTS),$(eval $(t)_CONFIG ?= host_tests/config/unit_dp.h))
