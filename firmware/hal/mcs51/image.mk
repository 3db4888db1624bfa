# How an image for an 8052 core is built. A board.mk includes this and calls
#
#   $(eval $(call mcs51_image,BOARD,NAME))     -> build/BOARD/NAME.ihx, .bin, .map
#
# after setting  BOARD_CONFIG, BOARD_CODE, BOARD_XRAM   configuration header, octets of program memory and external RAM
#                BOARD/NAME_SRC, BOARD/NAME_DEFAULTS    C files; the one with main() first
#                BOARD/NAME_XRAM                        external RAM, where it is not the board's
#                BOARD_CFLAGS, BOARD/NAME_CFLAGS        what else the compiler should know
# and giving NAME a row in boards/BOARD/budget.txt. MCS51_IMAGES are all of them: host_tests/mcs51.mk checks each.

# --nooverlay: SDCC would share the memory of locals between functions without asking which of them are interrupts.
MCS51_CC = sdcc -mmcs51 --std-c11 --model-large --nooverlay --opt-code-size --Werror
MCS51_INCLUDES = -Ifirmware -Ifirmware/hal/mcs51 -I. -Iboards/common

mcs51_options = $(MCS51_CC) $(MCS51_INCLUDES) -Iboards/$1 -DFIELDLING_CONFIG='"$($1_CONFIG)"' $($1_CFLAGS) $($1/$2_CFLAGS)

# The Modbus inverter. Every octet is looked at: it must last longer than the receiver takes (s51_modbus.py). Answers are
# sent octet by octet, main going on meanwhile; a gap below 1.5 characters is none. 110, 126: an `if` on a constant.
MCS51_MODBUS = $(addprefix firmware/hal/mcs51/,octet.c divide.c crc16_append.c) $(filter-out boards/common/main_modbus.c boards/common/line_console.c firmware/crc16_append.c,$(CONSOLE_MODBUS))
MCS51_MODBUS_CFLAGS = -DMB_CONFIG='"inverter_mb.h"' -DMB_WITH_LUMPS=0 -DCRC16_ENTRIES=512 -DINV_STEP_MS=50 -DINV_PARTS_A_PASS=1u \
                      -DMIN_OCTET_CYCLES=400u -DPOLLED_BIT_CYCLES=1u --disable-warning 110 --disable-warning 126

# C to assembly (build/BOARD/NAME.c/), functions nobody calls left out (build/BOARD/NAME/), then assembled and linked (link.sh).
ifndef mcs51_image
define mcs51_image # BOARD NAME
$$(call remember,build/$1/$2.c/options,$$(call mcs51_options,$1,$2))
build/$1/$2.c/%.asm: %.c $$(wildcard firmware/*.h firmware/*/*.h firmware/hal/mcs51/*.h boards/common/*.h boards/$1/*.h) \
                     firmware/hal/mcs51/image.mk build/$1/$2.c/options
	@mkdir -p $$(@D)
	$$(call say,SDCC,$$@)out=$$$$($$(call mcs51_options,$1,$2) -S $$< -o $$@ 2>&1) && test -z "$$$$out" || { echo "$$$$out"; rm -f $$@; exit 1; }
build/$1/$2.ihx: $$(patsubst %.c,build/$1/$2.c/%.asm,$$($1/$2_SRC) $$($1/$2_DEFAULTS)) $$(wildcard firmware/hal/mcs51/*.py firmware/hal/mcs51/*/*.py) firmware/hal/mcs51/link.sh
	$$(call say,LINK51,$$@)sh firmware/hal/mcs51/link.sh build/$1/$2 "$$($1/$2_SRC)" "$$($1/$2_DEFAULTS)" \
	    $$(MCS51_CC) --code-size $$($1_CODE) --xram-size $$(or $$($1/$2_XRAM),$$($1_XRAM)) --iram-size 256
build/$1/$2.bin: build/$1/$2.ihx
	$$(call say,BIN,$$@)makebin -p $$< $$@
BOARD_IMAGES += build/$1/$2.ihx build/$1/$2.bin
MCS51_IMAGES += build/$1/$2.ihx
endef
endif
