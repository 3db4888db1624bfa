# Modbus: unit tests in virtual time, the host station against foreign clients, figures.

MB_STATION  = firmware/crc16.c $(wildcard firmware/modbus/mb_*.c)
MB_DEFAULTS = $(wildcard firmware/modbus/default_*.c)

MB_UNIT_TESTS = test_modbus_functions test_modbus_line
define mb_unit_test
UNIT_TESTS += $1
$1_SRC      = host_tests/modbus_fixture.c sim/modbus_client.c sim/modbus_frame.c $$(HAL_VIRTUAL) $$(MB_STATION)
$1_DEFAULTS = $$(MB_DEFAULTS)
$1_CFLAGS   = -DMB_CONFIG='"host_tests/mb_test.h"'
endef
$(foreach t,$(MB_UNIT_TESTS),$(eval $(call mb_unit_test,$t)))

PROGRAMS += fieldling-modbus
fieldling-modbus_SRC      = boards/posix/fieldling_modbus.c boards/posix/mb_image.c boards/posix/mb_trace.c \
                            boards/common/inverter.c boards/common/inverter_store.c boards/common/inverter_modbus.c \
                            sim/modbus_frame.c $(HOST_STATION) $(MB_STATION)
fieldling-modbus_DEFAULTS = $(MB_DEFAULTS)
fieldling-modbus_CFLAGS   = -DMB_CONFIG='"inverter_mb.h"' -Iboards/common -Iboards/posix
