# Masters nobody here wrote, against the host station.

SCRIPT_TESTS += host_tests/interop_pyprofibus.py host_tests/interop_profirust.py
host_tests/interop_pyprofibus.py_TIMEOUT := 240
host_tests/interop_profirust.py_TIMEOUT  := 240
