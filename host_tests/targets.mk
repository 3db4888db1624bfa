# The boards: the contract of the port on every machine, images under foreign masters, what it all takes.

# ---- the contract of hal.h -------------------------------------------------------------------------------------------

UNIT_TESTS += hal_contract
hal_contract_SRC    = host_tests/contract/virtual/peer.c $(HAL_VIRTUAL)
hal_contract_CFLAGS = -Ihost_tests -Ihost_tests/contract/virtual
