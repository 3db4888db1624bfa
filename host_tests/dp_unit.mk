# Unit tests of the DP stack, module by module, on a machine without time (fake_hal.c).

FDL_UNIT_TESTS  := $(addprefix test_fdl_,services retry sap small) test_fma
DDLM_UNIT_TESTS := $(addprefix test_ddlm_,prm cfg diag data addr wd states no_inputs no_outputs plain adapt)
DP_UNIT_TESTS   := test_bytes test_phy_uart test_fdl_rx test_fdl_tx test_ddlm_identifiers $(FDL_UNIT_TESTS) \
    $(DDLM_UNIT_TESTS)
UNIT_TESTS += $(DP_UNIT_TESTS)

UNIT_PHY  := host_tests/fake_hal.c firmware/phy_uart/phy_uart.c
UNIT_FDL  := $(UNIT_PHY) $(addprefix firmware/fdl/,fdl.c fdl_rx.c fdl_tx.c fdl_sap.c fma.c fma_watch.c)
UNIT_DDLM := $(UNIT_FDL) host_tests/ddlm_unit.c \
    $(addprefix firmware/ddlm/ddlm,.c _addr.c _cfg.c _data.c _diag.c _identifiers.c _prm.c _wd.c)

test_phy_uart_SRC := $(UNIT_PHY)
test_fdl_rx_SRC   := $(UNIT_PHY) firmware/fdl/fdl_rx.c
test_fdl_tx_SRC   := host_tests/fake_hal.c firmware/fdl/fdl_tx.c firmware/fdl/fdl_sap.c
test_ddlm_identifiers_SRC := host_tests/fake_hal.c firmware/ddlm/ddlm_identifiers.c
$(foreach t,$(FDL_UNIT_TESTS),$(eval $(t)_SRC := $(UNIT_FDL) host_tests/fdl_unit.c)\
    $(eval $(t)_DEFAULTS := firmware/fdl/fma_event_default.c))
$(foreach t,$(DDLM_UNIT_TESTS),$(eval $(t)_SRC := $(UNIT_DDLM) host_tests/ddlm_unit_app.c)\
    $(eval $(t)_DEFAULTS := firmware/fdl/fma_event_default.c))

# The one that implements no callback: all of them come from the library.
test_ddlm_plain_SRC      := $(UNIT_DDLM)
test_ddlm_plain_DEFAULTS := firmware/fdl/fma_event_default.c $(wildcard firmware/ddlm/default_*.c)

# Their devices; host_tests/config says what is special about each.
test_fdl_small_CONFIG := host_tests/config/unit_small.h
test_ddlm_plain_CONFIG := host_tests/config/unit_plain.h
test_ddlm_no_inputs_CONFIG := host_tests/config/unit_no_inputs.h
test_ddlm_no_outputs_CONFIG := host_tests/config/unit_no_outputs.h
test_ddlm_adapt_CONFIG := host_tests/config/unit_adapt.h
$(foreach t,$(DP_UNIT_TESTS),$(eval $(t)_CONFIG ?= host_tests/config/unit_dp.h))
