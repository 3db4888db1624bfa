# HDLC: the wire, the chip model, the driver, the secondary, the remote modules and their master station.

HDLC_ALL      := $(sort $(wildcard firmware/hdlc/*.c))
HDLC_DEFAULTS := $(filter %_default.c,$(HDLC_ALL))
HDLC_SRC      := $(filter-out $(HDLC_DEFAULTS),$(HDLC_ALL))

# The modelled chip, as a program's port sees it; the station on one line of bits in virtual time.
HDLC_CHIP = firmware/hal/posix/hal_8273_model.c sim/i8273.c sim/i8273_line.c sim/hdlc_bits.c
HDLC_BUS  = $(HDLC_CHIP) $(HAL_VIRTUAL) sim/hdlc_bus.c host_tests/hdlc_no_uart.c

UNIT_TESTS += test_hdlc_bits
test_hdlc_bits_SRC = sim/hdlc_bits.c

UNIT_TESTS += test_i8273
test_i8273_SRC = sim/i8273.c sim/i8273_line.c sim/hdlc_bits.c

UNIT_TESTS += test_hdlc_8273
test_hdlc_8273_SRC      = $(HDLC_SRC) $(HDLC_BUS)
test_hdlc_8273_DEFAULTS = $(HDLC_DEFAULTS)

# Remote modules: the application, on a board of the test's.
REMOTE_MODULE = $(addprefix boards/common/remote_,module.c document.c log.c check.c) firmware/crc16.c
REMOTE_TEST   = $(REMOTE_MODULE) $(HDLC_SRC) $(HDLC_BUS) host_tests/remote_board_fake.c

# Tests of frames: over the modelled chip, and portable over a stand-in for the driver.
HDLC_PEER      = host_tests/hdlc_peer.c host_tests/hdlc_peer_chip.c sim/hdlc_pcap.c $(HDLC_BUS)
HDLC_PEER_FAKE = $(addprefix host_tests/,hdlc_peer.c hdlc_peer_fake.c fake_hal.c hdlc_no_uart.c) \
                 firmware/hdlc/hdlc_nrm.c firmware/hdlc/hdlc_cmd.c
define hdlc_test # TEST,SOURCES
UNIT_TESTS += $1
$1_SRC      = $2 $$(HDLC_SRC) $$(HDLC_PEER)
$1_DEFAULTS = $$(HDLC_DEFAULTS)
$(call portable_test,$1,hdlc,$2 $(HDLC_PEER_FAKE),,$(filter-out %_dma_default.c,$(HDLC_DEFAULTS)))
$$(eval $$(call fake_test,$1))
endef
$(eval $(call hdlc_test,test_hdlc_nrm))
$(eval $(call hdlc_test,test_remote_module,$(REMOTE_MODULE) host_tests/remote_board_fake.c))
$(eval $(call hdlc_test,test_remote_wrap,$(REMOTE_MODULE) host_tests/remote_board_fake.c))

UNIT_TESTS += test_hdlc_line
test_hdlc_line_SRC      = $(REMOTE_TEST) host_tests/hdlc_peer.c host_tests/hdlc_peer_chip.c sim/hdlc_pcap.c
test_hdlc_line_DEFAULTS = $(HDLC_DEFAULTS)

# The primary on the line: every fault at every frame.
UNIT_TESTS += test_hdlc_recovery
test_hdlc_recovery_SRC      = $(REMOTE_TEST) sim/hdlc_primary.c sim/hdlc_master.c
test_hdlc_recovery_DEFAULTS = $(HDLC_DEFAULTS)

UNIT_TESTS += test_hdlc_errors
test_hdlc_errors_SRC      = $(REMOTE_TEST)
test_hdlc_errors_DEFAULTS = $(HDLC_DEFAULTS)
test_hdlc_errors_TIMEOUT  = 400

UNIT_TESTS += test_hdlc_fuzz
test_hdlc_fuzz_SRC      = $(REMOTE_TEST)
test_hdlc_fuzz_DEFAULTS = $(HDLC_DEFAULTS)
test_hdlc_fuzz_TIMEOUT  = 400

# Host programs: a remote module; the master station.
PROGRAMS += fieldling-hdlc
fieldling-hdlc_SRC      = boards/posix/fieldling_hdlc.c boards/posix/hdlc_line.c boards/posix/rm_host_board.c \
                          sim/hdlc_words.c $(REMOTE_MODULE) $(HDLC_SRC) $(HDLC_CHIP) $(HOST_STATION)
fieldling-hdlc_DEFAULTS = $(HDLC_DEFAULTS)

PROGRAMS += fieldling-hdlc-master
HDLC_SCREEN := $(if $(wildcard /usr/include/ncurses.h /usr/include/*/ncurses.h),master_screen.c,master_screen_none.c)
fieldling-hdlc-master_SRC      = $(addprefix boards/posix/,fieldling_hdlc_master.c master_commands.c master_config.c \
                                 report.c hdlc_line.c options.c $(HDLC_SCREEN)) sim/hdlc_primary.c \
                                 firmware/hdlc/hdlc_8273.c $(HDLC_CHIP) $(HAL_REALTIME)
fieldling-hdlc-master_LDLIBS   = $(if $(filter master_screen.c,$(HDLC_SCREEN)),-lncurses)

PROGRAMS += fieldling-hdlc-cable
fieldling-hdlc-cable_SRC = sim/hdlc_cable_main.c sim/hdlc_bits.c sim/hdlc_pcap.c boards/posix/options.c

.PHONY: run-hdlc
run-hdlc: $(addprefix build/posix/,fieldling-hdlc fieldling-hdlc-master fieldling-hdlc-cable)
	@sh boards/posix/hdlc_demo.sh

SCRIPT_TESTS += host_tests/hdlc_host.py
host_tests/hdlc_host.py_TIMEOUT = 300

# 31 modules on one line, in virtual time.
PROGRAMS += fieldling-hdlc-scan
fieldling-hdlc-scan_SRC      = boards/posix/fieldling_hdlc_scan.c $(REMOTE_MODULE) $(HDLC_SRC) $(HDLC_BUS) \
                               sim/hdlc_primary.c boards/posix/options.c
fieldling-hdlc-scan_DEFAULTS = $(HDLC_DEFAULTS)

BENCHES += bench-hdlc
.PHONY: bench-hdlc
bench-hdlc: build/posix/fieldling-hdlc-scan
	@echo "HDLC, one scan of 31 modules at 7200 bit/s against the bits on the line alone:"
	@build/posix/fieldling-hdlc-scan
	@build/posix/fieldling-hdlc-scan --preframe
	@build/posix/fieldling-hdlc-scan --document
	@build/posix/fieldling-hdlc-scan --document --preframe

# The four modules on the 87C51FB.
$(foreach t,$(HDLC_IMAGES),$(eval $(call hdlc_image,$t)))

SCRIPT_TESTS_ONCE += host_tests/hdlc_chip.py
host_tests/hdlc_chip.py_TIMEOUT = 400

BENCHES += bench-hdlc-chip
.PHONY: bench-hdlc-chip
bench-hdlc-chip: $(foreach t,$(HDLC_IMAGES),build/87c51fb_hdlc/module-$t.ihx)
	@python3 host_tests/hdlc_chip.py --figures
