# Seeing and driving the bus: PA frames, GSD, analyzer, master.

UNIT_TESTS += test_pa_frame
test_pa_frame_SRC = firmware/fdl/pa_frame.c
UNIT_TESTS += test_pa_errors
test_pa_errors_SRC = firmware/fdl/pa_frame.c

# ---- GSD: gsd/FLDL1234.GSD is committed; a test proves that it is what the configuration says ---------------

PROGRAMS += fieldling-gsd
fieldling-gsd_SRC    = gsd/gsd_main.c
fieldling-gsd_CFLAGS = -DBOARD_RATES='"boards/posix/dp_rates.h"'

# What the same device is on each other board: other rates.
GSD_BOARDS := $(filter-out posix,$(patsubst boards/%/dp_rates.h,%,$(wildcard boards/*/dp_rates.h)))
GSD_FILES  := $(patsubst %,build/gsd/%/FLDL1234.GSD,$(GSD_BOARDS))

build/gsd/%/FLDL1234.GSD: gsd/gsd_main.c boards/%/dp_rates.h boards/common/dp_test01.h firmware/config.h
	@mkdir -p $(@D)
	$(call say,GSD,$@)gcc $(WARNINGS) $(INCLUDES) -DFIELDLING_CONFIG='"dp_test01.h"' \
	    -DBOARD_RATES='"boards/$*/dp_rates.h"' $< -o $(@D)/gsd && $(@D)/gsd >$@

# made with the boards' images: a test holds each against its board's clock
BOARD_IMAGES += $(GSD_FILES)

.PHONY: gsd
gsd: build/posix/fieldling-gsd $(GSD_FILES)
	@name=$$($< --name) && $< >gsd/$$name && python3 gsd/check gsd/$$name $(GSD_FILES)

all: $(GSD_FILES)

SCRIPT_TESTS_ONCE += host_tests/gsd_check.py

UNIT_TESTS += test_gsd_rates
test_gsd_rates_SRC      = boards/posix/dp_many.c $(DP_STATION) $(HAL_VIRTUAL)
test_gsd_rates_DEFAULTS = $(DP_DEFAULTS)

# ---- analyzer ---------------------------------------------------------------------------------------------------

MON = $(addprefix sim/,mon_split.c mon_record.c mon_pair.c mon_view.c mon_details.c mon_other.c mon_modbus.c mon_stats.c \
                       mon_plot.c mon_pcapng.c) sim/telegram.c

PROGRAMS += fieldling-mon
fieldling-mon_SRC    = sim/fieldling_mon.c sim/port.c $(MON)
fieldling-mon_LDLIBS = -lm

SCRIPT_TESTS += host_tests/mon_views.py host_tests/wireshark.py
SCRIPT_TESTS_ONCE += host_tests/sigrok.py

# ---- master for people ----------------------------------------------------------------------------------------

PROGRAMS += fieldling-master
fieldling-master_SRC = $(addprefix sim/,fieldling_master.c master_ask.c master_cyclic.c master_keys.c master_line.c master_say.c \
                                        master_setup.c gsd_read.c port.c) $(SIM_MASTER) \
                       $(addprefix boards/posix/,dp_sim_line.c dp_sim_view.c dp_words.c) $(SIM_SEGMENT) $(DP_STATION)
fieldling-master_DEFAULTS = $(DP_DEFAULTS)

SCRIPT_TESTS += host_tests/dp_master.py host_tests/gsd_pyprofibus.py

# ---- 124 stations: each a copy of one shared object (sim/many.h) -------------------------------------------------

PROGRAMS += fieldling-station.so
fieldling-station.so_SRC      = boards/posix/dp_many.c $(DP_STATION) $(HAL_VIRTUAL)
fieldling-station.so_DEFAULTS = $(DP_DEFAULTS)
fieldling-station.so_CFLAGS   = -fPIC
fieldling-station.so_LDLIBS   = -shared -Wl,-Bsymbolic

PROGRAMS += fieldling-many
fieldling-many_SRC    = sim/fieldling_many.c $(SIM_MASTER)
fieldling-many_LDLIBS = -ldl

BENCHES += bench-many
bench-many: build/posix/fieldling-many build/posix/fieldling-station.so
	@build/posix/fieldling-many build/posix/fieldling-station.so bench

SCRIPT_TESTS += host_tests/dp_many.py
host_tests/dp_many.py_TIMEOUT := 300
