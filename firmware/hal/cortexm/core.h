/* The Cortex-M core: vectors, NVIC, and SysTick as the free-running clock. Source: ARMv7-M Architecture Reference Manual,
 * B3. A part adds its UART and timer (uart.h) and a board its numbers (hal_board.h). */
#ifndef FIELDLING_CORTEXM_CORE_H
#define FIELDLING_CORTEXM_CORE_H

#include "check.h"

#define REG(address) (*(volatile uint32_t *)(address))

/* All interrupts the stack is called from have the same priority: none interrupts another. */
static inline void nvic_enable(uint8_t irq)
{
    REG(0xE000E100u + 4u * (irq / 32u)) = 1ul << (irq % 32u);
}

/* Clocks of the core since start, wraps at 32 bits. Must be called at least once in 2^24 clocks. lock, isr. */
uint32_t core_clocks_isr(void);

/* An interrupt has come since hal_idle() looked. Every handler of a part sets it. */
extern volatile bool core_interrupted;

/* Start over. Does not return. */
void core_reset(void) __attribute__((noreturn));

/* main() has returned, or a fault has come (255): the image is a test, or broken. Does not return. */
void core_exit(int status) __attribute__((noreturn));

/* Clocks, pins and interrupts of the part: from hal_init(), interrupts masked. Implemented by the part. */
void part_init(void);

/* Console output; waits a bounded time for room. Implemented by the part. */
void part_console_put(uint8_t octet);

#endif
