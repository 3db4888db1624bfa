# Tests of the simulated wire, and of the DP station on it, in virtual time.

UNIT_TESTS += test_hal_virtual
test_hal_virtual_SRC = $(HAL_VIRTUAL)

UNIT_TESTS += test_segment
test_segment_SRC = $(SIM_SEGMENT)

# DP-TEST01 with its own application, on the segment.
DP_TEST01_BENCH = $(DP_SRC) boards/common/dp_test01_app.c $(SIM_BUS) \
                  host_tests/dp_fixture.c host_tests/dp_station_test01.c

DP_TESTS = test_dp_frames test_dp_fcb test_dp_prm test_dp_cfg test_dp_data test_dp_diag test_dp_time test_dp_bus \
           test_dp_errors test_dp_model test_dp_lumps test_dp_user_sap test_dp_loop
UNIT_TESTS += $(DP_TESTS)
define dp_test
$1_SRC = $$(DP_TEST01_BENCH)
$1_DEFAULTS = $$(DP_DEFAULTS)
endef
$(foreach t,$(DP_TESTS),$(eval $(call dp_test,$t)))

# A station of any configuration, straight from and to memory.
DP_ANY_BENCH = $(DP_SRC) $(SIM_BUS) host_tests/dp_fixture.c host_tests/dp_station_any.c

UNIT_TESTS += test_dp_replay
test_dp_replay_SRC = $(DP_ANY_BENCH)
test_dp_replay_CONFIG := host_tests/config/dp_any.h
test_dp_replay_DEFAULTS = $(DP_DEFAULTS)

# The stack with a call before every access to memory, where the test interrupts it; nothing else is compiled so. The
# station itself has the callbacks left out here.
PREEMPT_OBJ = $(patsubst %.c,build/test/obj/preempt/%.o,\
    $(filter-out %/default_adapt_cfg.c %/default_fault.c,$(DP_ALL)))
build/test/obj/preempt/%.o: %.c
	@mkdir -p $(@D)
	$(call say,CC,$@)gcc $(WARNINGS) $(INCLUDES) -O1 -g -fsanitize=thread -MMD -MP \
	    -DFIELDLING_CONFIG='"$(test_dp_consistency_CONFIG)"' -c $< -o $@
-include $(PREEMPT_OBJ:.o=.d)

UNIT_TESTS += test_dp_consistency
test_dp_consistency_SRC = $(SIM_BUS) host_tests/dp_fixture.c host_tests/dp_station_any.c
test_dp_consistency_CONFIG := host_tests/config/dp_any.h
build/test/test_dp_consistency build/asan/test_dp_consistency: $(PREEMPT_OBJ)

SCRIPT_TESTS += host_tests/segment_pty.py

PROGRAMS += bench-dp-2 bench-dp-32
BENCH_DP = host_tests/bench_dp.c $(DP_SRC) $(HAL_VIRTUAL) sim/dp_questions.c sim/telegram.c
bench-dp-2_SRC  = $(BENCH_DP)
bench-dp-32_SRC = $(BENCH_DP)
bench-dp-32_CONFIG := host_tests/config/dp_any.h
bench-dp-2_DEFAULTS  = $(DP_DEFAULTS)
bench-dp-32_DEFAULTS = $(DP_DEFAULTS)
BENCHES += bench-dp
bench-dp: build/posix/bench-dp-2 build/posix/bench-dp-32
	@sh host_tests/bench_dp.sh
