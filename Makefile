# Fieldling: `make help` lists what can be asked for.
#
# This file holds the rules; what is built is said by the fragments it includes (sim/*.mk, boards/*/board.mk,
# host_tests/*.mk). A fragment appends to these lists, paths from the top folder:
#
#   PROGRAMS     += fieldling-x         host program build/posix/fieldling-x (gcc alone must be enough)
#     fieldling-x_SRC                   its C files
#     fieldling-x_CONFIG                the device's configuration header, found in boards/common or by _CFLAGS;
#                                       dp_test01.h when not given
#     fieldling-x_CFLAGS, _LDLIBS       own options, optional
#     fieldling-x_DEFAULTS              C files of default callbacks: linked from an archive, so that a function
#                                       of the same name in _SRC takes the place of the default; optional
#   UNIT_TESTS   += test_x              host_tests/test_x.c with Unity -> build/test/test_x, and build/asan/test_x
#     test_x_SRC                        the files under test
#     test_x_MAIN                       the tests, when they are not in host_tests/test_x.c; optional
#     test_x_CONFIG, _CFLAGS, _LDLIBS, _DEFAULTS as above; test_x_TIMEOUT [s]
#   SCRIPT_TESTS += host_tests/x.py     ends with Unity's summary line; finds its programs in $FIELDLING_BIN;
#     host_tests/x.py_TIMEOUT [s]       run with the gcc programs and again with the sanitized ones
#   SCRIPT_TESTS_ONCE += host_tests/x.sh  the same for a script that runs no host program of ours: once
#   QUICK_TESTS  += host_tests/x.py     like _ONCE, and fast: run by `make check` too
#   LONG_TESTS   += host_tests/x.py     like _ONCE, for hours: run by `make test-long` alone
#   BOARD_IMAGES += build/87c51fb/x.ihx   built by `make test`; the fragment has the rule
#   STATIC       += a-target            run by `make check`
#   BENCHES      += bench-x             a target, run by `make bench`, one after the other
#   SIZES        += size-x              a target, run by `make size`
#   run-dp, run-modbus                  targets behind `make run PROTOCOL=...`
#   run-board-X                         target behind `make run BOARD=X`
#
# Tests see TEST_FULL=1 in the environment when run by `make test`: then they use their big random counts.

PROTOCOL ?= dp
PYTHON   := build/venv/bin/python

.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:
.SECONDARY:

# ---- how a C file is compiled, by variant: posix = programs, test = unit tests, asan = both, with clang;
# ---- clang = both, for its warnings only, at a quarter of the price of asan

WARNINGS := -std=c99 -Wall -Wextra -Wconversion -Werror -D_POSIX_C_SOURCE=200809L -D_DEFAULT_SOURCE
INCLUDES := -I. -Ifirmware -Ifirmware/hal/posix -Iboards/common
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer

posix_CC     := gcc
posix_CFLAGS := -O2 -g
test_CC      := gcc
test_CFLAGS  := -O1 -g -Ibuild/unity
asan_CC      := clang
asan_CFLAGS  := -O1 -g -Ibuild/unity $(SANITIZE)
asan_LDFLAGS := $(SANITIZE)
clang_CC     := clang
clang_CFLAGS := -O0 -Ibuild/unity

# ---- the DP stack, for everybody's fragment ----------------------------------------------------------------
#
#   x_SRC = $(DP_STATION) ...     the stack and the application of DP-TEST01
#   x_DEFAULTS = $(DP_DEFAULTS)   the defaults of its optional callbacks

DP_ALL      := $(filter-out %/pa_frame.c,$(wildcard firmware/phy_uart/*.c firmware/fdl/*.c firmware/ddlm/*.c))
DP_DEFAULTS := $(filter %_default.c firmware/ddlm/default_%.c,$(DP_ALL))
DP_SRC      := $(filter-out $(DP_DEFAULTS),$(DP_ALL))
DP_STATION  := $(DP_SRC) boards/common/dp_test01_app.c

# The same with a console, for boards.
CONSOLE_DP = boards/common/main_dp_console.c boards/common/dp_console.c boards/common/line_console.c $(DP_STATION)

# One short line per file; `make V=1` shows the commands.
say = $(if $(V),,@echo "  $1  $2" && )

# $(call remember,FILE,TEXT): rewrites FILE when TEXT has changed; what depends on FILE follows changed options.
remember = $(if $(filter-out x$(strip $(file <$1))x,x$(strip $2)x),$(shell mkdir -p $(dir $1))$(file >$1,$2))

include boards/images.mk
include $(sort $(wildcard sim/*.mk boards/*/board.mk host_tests/*.mk))

UNITY := build/unity/unity.c

# Objects are shared by what is compiled with the same options: a set is a configuration header, or the name of a
# program with options of its own.
config  = $(or $($1_CONFIG),dp_test01.h)
objset  = $(if $(strip $($1_CFLAGS)),$1,$(basename $(call config,$1)))
options = -DFIELDLING_CONFIG='"$(call config,$1)"' $($1_CFLAGS)
objects = $(patsubst %.c,build/$1/obj/$(call objset,$2)/%.o,$3)

define compile_rule # VARIANT SET OPTIONS
$(call remember,build/$1/obj/$2/options,$($1_CC) $(WARNINGS) $3 $(INCLUDES) $($1_CFLAGS))
build/$1/obj/$2/%.o: %.c build/$1/obj/$2/options
	@mkdir -p $$(@D)
	$$(call say,CC,$$@)$($1_CC) $(WARNINGS) $3 $(INCLUDES) $($1_CFLAGS) -MMD -MP -c $$< -o $$@
build/$1/obj/$2/build/unity/%.o: build/unity/%.c
	@mkdir -p $$(@D)
	$$(call say,CC,$$@)$($1_CC) -w $($1_CFLAGS) -c $$< -o $$@
rule_$1_$2 := 1
endef

define link_rule # VARIANT NAME SOURCES
$(call remember,build/$1/obj/$2.parts,$3 : $($2_DEFAULTS) : $($2_LDLIBS))
build/$1/$2: $(call objects,$1,$2,$3) $(if $($2_DEFAULTS),build/$1/obj/$2.a) build/$1/obj/$2.parts
	$$(call say,LD,$$@)$($1_CC) $($1_LDFLAGS) $$(filter %.o %.a,$$^) $($2_LDLIBS) -o $$@
build/$1/obj/$2.a: $(call objects,$1,$2,$($2_DEFAULTS)) build/$1/obj/$2.parts
	$$(call say,AR,$$@)rm -f $$@.new && ar rcs $$@.new $$(filter %.o,$$^) && mv $$@.new $$@
-include $(patsubst %.o,%.d,$(call objects,$1,$2,$3 $($2_DEFAULTS)))
endef

test_sources = $(UNITY) $(or $($1_MAIN),host_tests/$1.c) $($1_SRC)

# $(call build,VARIANT,NAME,SOURCES): the rules for one program, and for its set of objects if they are not there yet
build = $(if $(rule_$1_$(call objset,$2)),,$(eval $(call compile_rule,$1,$(call objset,$2),$(call options,$2))))\
        $(eval $(call link_rule,$1,$2,$3))
$(foreach p,$(PROGRAMS),$(foreach v,posix asan clang,$(call build,$v,$p,$($p_SRC))))
$(foreach t,$(UNIT_TESTS),$(foreach v,test asan clang,$(call build,$v,$t,$(call test_sources,$t))))

# ---- what a user asks for --------------------------------------------------------------------------------

RUN_PY = $(PYTHON) host_tests/run.py
# Sub-makes build on both cores unless the user said something else.
J = $(if $(findstring -j,$(MAKEFLAGS)),,-j2)
# name=seconds for tests that say so.
timed = $(foreach t,$1,$2$t$(if $($t_TIMEOUT),=$($t_TIMEOUT)))

POSIX_PROGRAMS := $(addprefix build/posix/,$(PROGRAMS))
ASAN_PROGRAMS  := $(addprefix build/asan/,$(PROGRAMS))
TEST_PROGRAMS  := $(addprefix build/test/,$(UNIT_TESTS))
ASAN_TESTS     := $(addprefix build/asan/,$(UNIT_TESTS))
CLANG_OBJECTS  := $(sort $(foreach p,$(PROGRAMS),$(call objects,clang,$p,$($p_SRC) $($p_DEFAULTS))) \
                         $(foreach t,$(UNIT_TESTS),$(call objects,clang,$t,$(call test_sources,$t) $($t_DEFAULTS))))

.PHONY: all setup run flash test test-long check asan bench size clean help build-tests build-asan check-clang boards static \
        $(BENCHES) $(SIZES) $(STATIC)

all: $(POSIX_PROGRAMS)
	@:

setup:
	@sh host_tests/setup.sh

# A board runs on the test machinery; the host's own demonstrations need a compiler, and HDLC's picture a library.
run:
	@$(if $(BOARD),sh host_tests/setup.sh,$(if $(filter hdlc,$(PROTOCOL)),sh host_tests/setup.sh libncurses-dev &&) \
	    { command -v gcc >/dev/null || sh host_tests/setup.sh gcc libc6-dev; })
	@$(MAKE) --no-print-directory $J all
	@$(MAKE) --no-print-directory $(if $(BOARD),run-board-$(BOARD),run-$(PROTOCOL))

flash:
	@$(MAKE) --no-print-directory flash-$(or $(BOARD),which-board)

build-tests: $(POSIX_PROGRAMS) $(TEST_PROGRAMS)
	@:
build-asan: $(ASAN_PROGRAMS) $(ASAN_TESTS)
	@:
check-clang: $(CLANG_OBJECTS)
	@:
boards: $(BOARD_IMAGES)
	@:
static: $(STATIC)
	@:

test: setup
	@$(MAKE) --no-print-directory $J build-tests build-asan boards static
	@TEST_FULL=1 $(RUN_PY) $(call timed,$(UNIT_TESTS),build/test/) $(call timed,$(UNIT_TESTS),build/asan/) \
	    $(call timed,$(QUICK_TESTS) $(SCRIPT_TESTS_ONCE)) $(call timed,$(SCRIPT_TESTS)) --asan $(call timed,$(SCRIPT_TESTS))

test-long: setup
	@$(MAKE) --no-print-directory $J all boards
	@TEST_FULL=1 $(RUN_PY) $(call timed,$(LONG_TESTS))

check:
	@test -d build/unity && test -x $(PYTHON) || sh host_tests/setup.sh
	@$(MAKE) --no-print-directory $J build-tests check-clang static
	@$(RUN_PY) $(call timed,$(UNIT_TESTS),build/test/) $(call timed,$(QUICK_TESTS))

asan:
	@$(MAKE) --no-print-directory $J build-asan
	@$(RUN_PY) $(call timed,$(UNIT_TESTS),build/asan/)

bench: all
	@for b in $(BENCHES); do $(MAKE) --no-print-directory $$b || exit 1; done

size: all
	@for s in $(SIZES); do $(MAKE) --no-print-directory $$s || exit 1; done
	@size $(POSIX_PROGRAMS)

clean:
	rm -rf build

help:
	@echo "make                     every host program into build/posix/ (needs gcc, nothing else)"
	@echo "make setup               install what tests and demos need; says what it does, quick when all is there"
	@echo "make run PROTOCOL=dp     live demonstration: a station and a master on a simulated bus (dp, modbus, hdlc)"
	@echo "make run STATIONS=8      so many stations and one master on a segment of pseudo terminals (1 to 14)"
	@echo "make run BOARD=com86     the same with a simulated board as the station (com86, lm3s6965evb, rv32virt, 87c51fb)"
	@echo "make run BOARD=87c51fb PROTOCOL=modbus  the inverter on the simulated 8051, libmodbus as its client"
	@echo "make flash BOARD=bluepill  program a board (bluepill, 87c51fb, stc89c58rd with PORT=/dev/...)"
	@echo "make check               unit tests, 8051 and Cortex-M compile, static checks: about a minute"
	@echo "make asan                the unit tests again, by clang with AddressSanitizer and UBSan"
	@echo "make test                everything: all boards, sanitizers, foreign masters; ends in N passed, N failed"
	@echo "make test-long           what takes too long for that: the 8051 at every rate, every bit, every moment"
	@echo "make bench               measured figures on this machine"
	@echo "make size                code and RAM of programs and images"
	@echo "make clean               remove build/"
