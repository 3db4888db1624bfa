# Module tests on a machine without time (fake_hal.c): the same sources and assertions on the host and on the targets.

# $(call portable_test,TEST,SET,SOURCES,OPTIONS,DEFAULTS): host_tests/TEST.c is to run on the targets, too (targets.mk,
# s51_units.mk), with these sources. Tests of a SET have the same OPTIONS and share objects.
define portable_test
PORTABLE_TESTS += $1
$1_PORTABLE_SET := $2
$1_PORTABLE_SRC := $3
$1_PORTABLE_OPTIONS := $4
$1_PORTABLE_DEFAULTS := $5
endef

# $(call fake_test,TEST): a portable test whose host program runs on the virtual line, on the fake port as test fake_TEST.
define fake_test
UNIT_TESTS += fake_$1
fake_$1_MAIN := host_tests/$1.c
fake_$1_SRC := $($1_PORTABLE_SRC)
fake_$1_CFLAGS := $($1_PORTABLE_OPTIONS)
fake_$1_DEFAULTS := $($1_PORTABLE_DEFAULTS)
endef

# ---- the DP stack ----------------------------------------------------------------------------------------------------

FDL_UNIT_TESTS  := $(addprefix test_fdl_,services retry sap small tx early) test_fma
DDLM_UNIT_TESTS := $(addprefix test_ddlm_,prm cfg diag data addr wd states no_inputs no_outputs plain adapt)
DP_UNIT_TESTS   := test_bytes test_phy_uart test_fdl_rx test_ddlm_identifiers $(FDL_UNIT_TESTS) \
    $(DDLM_UNIT_TESTS)
UNIT_TESTS += $(DP_UNIT_TESTS)

UNIT_PHY  := host_tests/fake_hal.c firmware/phy_uart/phy_uart.c
UNIT_FDL  := $(UNIT_PHY) $(addprefix firmware/fdl/,fdl.c fdl_plan.c fdl_rx.c fdl_tx.c fdl_sap.c fma.c fma_watch.c)
UNIT_DDLM := $(UNIT_FDL) host_tests/ddlm_unit.c \
    $(addprefix firmware/ddlm/ddlm,.c _addr.c _cfg.c _data.c _diag.c _identifiers.c _prm.c _wd.c)

test_phy_uart_SRC := $(UNIT_PHY)
test_fdl_rx_SRC   := $(UNIT_PHY) firmware/fdl/fdl_rx.c
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
$(foreach t,$(DP_UNIT_TESTS),$(eval $(call portable_test,$t,$(basename $(notdir $($t_CONFIG))),\
    $($t_SRC),-DFIELDLING_CONFIG='"$($t_CONFIG)"',$($t_DEFAULTS))))

# ---- the rest ----------------------------------------------------------------------------------------------------------

UNIT_TESTS += test_nv_log test_con_in test_crc16 test_crc16_small test_crc16_octets
test_nv_log_SRC := firmware/hal/nv_log.c
test_con_in_SRC := firmware/hal/con_in.c
test_crc16_SRC  := firmware/crc16.c firmware/crc16_append.c
test_crc16_small_MAIN   := host_tests/test_crc16.c
test_crc16_small_SRC    := $(test_crc16_SRC)
test_crc16_small_CFLAGS := -DCRC16_ENTRIES=16
test_crc16_octets_MAIN   := host_tests/test_crc16.c
test_crc16_octets_SRC    := $(test_crc16_SRC)
test_crc16_octets_CFLAGS := -DCRC16_ENTRIES=512
$(eval $(call portable_test,test_nv_log,plain,$(test_nv_log_SRC)))
$(eval $(call portable_test,test_con_in,plain,$(test_con_in_SRC)))
$(eval $(call portable_test,test_crc16,plain,$(test_crc16_SRC)))
$(eval $(call portable_test,test_crc16_small,small,$(test_crc16_small_SRC),$(test_crc16_small_CFLAGS)))
$(eval $(call portable_test,test_crc16_octets,octets,$(test_crc16_octets_SRC),$(test_crc16_octets_CFLAGS)))
$(eval $(call portable_test,test_pa_frame,plain,firmware/fdl/pa_frame.c))
