# Remote modules: 87C51FB (16 kB of EPROM), 8273, 32 kB of RAM. One image for each type of module.
include firmware/hal/mcs51/image.mk

87c51fb_hdlc_CONFIG := dp_test01.h
87c51fb_hdlc_CODE   := 0x4000
87c51fb_hdlc_XRAM   := 0x8000
87c51fb_hdlc_CFLAGS := -DCRC16_ENTRIES=16

87c51fb_hdlc_PARTS = boards/87c51fb_hdlc/board.c firmware/hal/mcs51/machine_8273.c $(REMOTE_MODULE) $(HDLC_SRC)

define hdlc_image
87c51fb_hdlc/module-$1_SRC      := boards/87c51fb_hdlc/main_$1.c $$(87c51fb_hdlc_PARTS)
87c51fb_hdlc/module-$1_DEFAULTS := $$(HDLC_DEFAULTS)
$$(eval $$(call mcs51_image,87c51fb_hdlc,module-$1))
endef
# The sources are listed by host_tests/hdlc.mk, which is read later.
HDLC_IMAGES = di do ai ao
