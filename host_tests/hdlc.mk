# HDLC: the wire, the chip model, the driver, the secondary, the remote modules and their master station.

UNIT_TESTS += test_hdlc_bits
test_hdlc_bits_SRC = sim/hdlc_bits.c
