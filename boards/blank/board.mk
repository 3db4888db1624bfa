# The empty port as an image: the whole DP station, linked for the 8051 and for a Cortex-M0. It shows that nothing
# outside the port is missing, and what the stack costs before a board adds its own (make size).

BLANK_APP  := boards/blank/main.c boards/common/dp_test01_app.c firmware/hal/hal_blank.c
blank_rels  = $(patsubst %.c,build/blank/mcs51/%.rel,$1)
blank_objs  = $(patsubst %.c,build/blank/cortexm0/%.o,$1)

# SDCC's linker only warns about what is undefined.
build/blank/dp.ihx: $(call blank_rels,$(BLANK_APP) $(DP_ALL))
	@rm -f $@ $(@:.ihx=.lib)
	$(call say,SDAR,$(@:.ihx=.lib))sdar -rcD $(@:.ihx=.lib) $(call blank_rels,$(DP_ALL)) >/dev/null
	$(call say,SDLD,$@)out=$$($(SDCC) $(call blank_rels,$(BLANK_APP)) $(@:.ihx=.lib) -o $@ 2>&1) && \
	    test -z "$$out" || { echo "$$out"; rm -f $@; exit 1; }

build/blank/dp.elf: $(call blank_objs,$(BLANK_APP) $(DP_ALL))
	@rm -f $@ $(@:.elf=.a)
	$(call say,AR,$(@:.elf=.a))arm-none-eabi-ar rcsD $(@:.elf=.a) $(call blank_objs,$(DP_ALL))
	$(call say,LD,$@)$(ARM_CC) -nostartfiles --specs=nosys.specs -Wl,-e,main,--gc-sections \
	    $(call blank_objs,$(BLANK_APP)) $(@:.elf=.a) -o $@

BOARD_IMAGES += build/blank/dp.ihx build/blank/dp.elf
STATIC += check-links
SIZES  += size-blank

check-links: build/blank/dp.ihx build/blank/dp.elf

size-blank: build/blank/dp.ihx build/blank/dp.elf
	@echo "DP station on the empty port, 8051 (internal RAM, external RAM, code):"
	@grep -A9 -E "^Stack starts|^Other memory" build/blank/dp.mem
	@echo "DP station on the empty port, Cortex-M0:"
	@arm-none-eabi-size build/blank/dp.elf
