# How an image for an 8052 core is built. A board.mk includes this and calls
#
#   $(eval $(call mcs51_image,BOARD,NAME))     -> build/BOARD/NAME.ihx, .bin, .map
#
# after setting  BOARD_CONFIG, BOARD_CODE, BOARD_XRAM   configuration header, octets of program memory and external RAM
#                BOARD/NAME_SRC, BOARD/NAME_DEFAULTS    C files; the one with main() first
#                BOARD_CFLAGS                           what else the compiler should know

# --nooverlay: SDCC would share the memory of locals between functions without asking which of them are interrupts.
MCS51_CC = sdcc -mmcs51 --std-c11 --model-large --nooverlay --opt-code-size --Werror
MCS51_INCLUDES = -Ifirmware -Ifirmware/hal/mcs51 -I. -Iboards/common

# C to assembly (build/BOARD/NAME.c/), functions nobody calls left out (build/BOARD/NAME/), then assembled and linked.
ifndef mcs51_image
define mcs51_image # BOARD NAME
build/$1/$2.c/%.asm: %.c $$(wildcard firmware/*.h firmware/*/*.h firmware/hal/mcs51/*.h boards/common/*.h boards/$1/*.h) \
                     firmware/hal/mcs51/image.mk boards/$1/board.mk
	@mkdir -p $$(@D)
	$$(call say,SDCC,$$@)out=$$$$($$(MCS51_CC) $$(MCS51_INCLUDES) -Iboards/$1 $$($1_CFLAGS) \
	    -DFIELDLING_CONFIG='"$$($1_CONFIG)"' -S $$< -o $$@ 2>&1) && test -z "$$$$out" || { echo "$$$$out"; rm -f $$@; exit 1; }
build/$1/$2.ihx: $$(patsubst %.c,build/$1/$2.c/%.asm,$$($1/$2_SRC) $$($1/$2_DEFAULTS)) firmware/hal/mcs51/strip_unused.py
	$$(call say,LINK51,$$@)sh firmware/hal/mcs51/link.sh build/$1/$2 "$$($1/$2_SRC)" "$$($1/$2_DEFAULTS)" \
	    $$(MCS51_CC) --code-size $$($1_CODE) --xram-size $$($1_XRAM) --iram-size 256
build/$1/$2.bin: build/$1/$2.ihx
	$$(call say,BIN,$$@)makebin -p $$< $$@
BOARD_IMAGES += build/$1/$2.ihx build/$1/$2.bin
endef
endif
