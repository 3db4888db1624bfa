# Seeing and driving the bus: PA frames, GSD, analyzer, master.

UNIT_TESTS += test_pa_frame
test_pa_frame_SRC = firmware/fdl/pa_frame.c
