/* QEMU's RISC-V "virt" without its port, for tests of modules over the fake one: its UART to write to, and an end. */
#include "hal/riscv/core.h"
#include "hal_board.h"

void target_put(char c);

void target_put(char c)
{
    REG8(BOARD_CONSOLE_UART) = (uint8_t)c;
}

void core_exit(int status)
{
    REG(BOARD_EXIT) = status ? (uint32_t)status << 16 | 0x3333u : 0x5555u;
    for (;;) {
    }
}
