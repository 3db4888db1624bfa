/* The LM3S6965 board without its port, for tests of modules over the fake one: UART 0 to write to, and an end. */
#include "hal/cortexm/core.h"
#include "hal_board.h"
#include "semihosting.h"

#define UART_CR 0x30u
#define CR_ON   0x301u

void target_put(char c);

void target_put(char c)
{
    REG(BOARD_CONSOLE_UART + UART_CR) = CR_ON;
    REG(BOARD_CONSOLE_UART) = (uint8_t)c;
}

void core_exit(int status)
{
    semihosting_exit((uint8_t)status);
    for (;;) {
    }
}

__attribute__((section(".vectors.part"), used)) void (*const part_vectors[1])(void);
