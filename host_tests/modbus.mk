# Modbus: unit tests in virtual time and on the fake port, the host station against foreign clients, figures.

MB_STATION  = firmware/crc16.c firmware/crc16_append.c $(wildcard firmware/modbus/mb_*.c)
MB_DEFAULTS = $(wildcard firmware/modbus/default_*.c)
MB_FAKE     = host_tests/fake_hal.c host_tests/modbus_client_fake.c sim/modbus_frame.c

MB_UNIT_TESTS = test_modbus_functions test_modbus_identification test_modbus_line test_modbus_time test_modbus_noise
define mb_unit_test
UNIT_TESTS += $1
$1_SRC      = host_tests/modbus_fixture.c sim/modbus_client.c sim/modbus_frame.c $$(HAL_VIRTUAL) $$(MB_STATION)
$1_DEFAULTS = $$(MB_DEFAULTS)
$1_CFLAGS   = -DMB_CONFIG='"host_tests/mb_test.h"'
endef
$(foreach t,$(MB_UNIT_TESTS),$(eval $(call mb_unit_test,$t)))

# Those that need no finer time than a bit run on the fake port, too.
MB_PORTABLE := $(addprefix test_modbus_,functions identification line)
$(foreach t,$(MB_PORTABLE),$(eval $(call portable_test,$t,mb_test,host_tests/modbus_fixture.c $(MB_FAKE) $(MB_STATION),\
    -DMB_CONFIG='"host_tests/mb_test.h"',$(MB_DEFAULTS))))
$(foreach t,$(MB_PORTABLE),$(eval $(call fake_test,$t)))

PROGRAMS += fieldling-modbus
fieldling-modbus_SRC      = boards/posix/fieldling_modbus.c boards/posix/mb_image.c boards/posix/mb_trace.c \
                            boards/common/inverter.c boards/common/inverter_store.c boards/common/inverter_modbus.c \
                            sim/modbus_frame.c $(HOST_STATION) $(MB_STATION)
fieldling-modbus_DEFAULTS = $(MB_DEFAULTS)
fieldling-modbus_CFLAGS   = -DMB_CONFIG='"inverter_mb.h"' -Iboards/common -Iboards/posix

# Figures beside the peers': as tests with limits, and as a table in `make bench`.
SCRIPT_TESTS_ONCE += host_tests/modbus_figures.py
BENCHES += bench-modbus
bench-modbus:
	@test -x $(PYTHON) || sh host_tests/setup.sh
	@$(PYTHON) host_tests/modbus_figures.py --table
test_modbus_noise_TIMEOUT = 900

# Foreign clients.
LIBMODBUS = $(shell pkg-config --cflags --libs libmodbus 2>/dev/null || echo -lmodbus)
build/test/interop_libmodbus: host_tests/interop_libmodbus.c build/unity/unity.c
	@mkdir -p $(@D)
	$(call say,LD,$@)gcc $(WARNINGS) -O1 -g -Ibuild/unity $^ $(LIBMODBUS) -o $@
build-tests: build/test/interop_libmodbus
SCRIPT_TESTS += host_tests/interop_libmodbus.py host_tests/interop_modbus.py

# The inverter live, polled by libmodbus.
build/posix/modbus-live: sim/modbus_live.c boards/common/inverter_map.h
	@mkdir -p $(@D)
	$(call say,LD,$@)gcc $(WARNINGS) -D_XOPEN_SOURCE=700 -I. -O2 -g $< $(LIBMODBUS) -o $@
build-tests: build/posix/modbus-live
.PHONY: run-modbus
run-modbus: build/posix/modbus-live build/posix/fieldling-modbus
	@build/posix/modbus-live build/posix/fieldling-modbus

INVERTER := $(addprefix boards/common/inverter,.c _store.c _modbus.c _bind.c)
UNIT_TESTS += test_modbus_inverter test_modbus_inverter_parts
test_modbus_inverter_SRC      = $(INVERTER) sim/modbus_client.c sim/modbus_frame.c $(HAL_VIRTUAL) $(MB_STATION)
test_modbus_inverter_DEFAULTS = $(MB_DEFAULTS)
test_modbus_inverter_CFLAGS   = -DMB_CONFIG='"inverter_mb.h"' -Iboards/common
# As an 8051 does it: a part of a step in a pass.
test_modbus_inverter_parts_MAIN     = host_tests/test_modbus_inverter.c
test_modbus_inverter_parts_SRC      = $(test_modbus_inverter_SRC)
test_modbus_inverter_parts_DEFAULTS = $(MB_DEFAULTS)
test_modbus_inverter_parts_CFLAGS   = $(test_modbus_inverter_CFLAGS) -DINV_PARTS_A_PASS=1u
$(eval $(call portable_test,test_modbus_inverter,inverter,$(INVERTER) $(MB_FAKE) $(MB_STATION),\
    -DMB_CONFIG='"inverter_mb.h"',$(MB_DEFAULTS)))
$(eval $(call fake_test,test_modbus_inverter))

# The README's tables and example.
SCRIPT_TESTS_ONCE += host_tests/modbus_readme.py host_tests/modbus_rows.py
.PHONY: modbus-map
modbus-map:
	@$(PYTHON) host_tests/modbus_readme.py --write
host_tests/modbus_rows.py_TIMEOUT = 300
host_tests/interop_modbus.py_TIMEOUT = 300
