/* A RISC-V hart in machine mode: traps, the machine timer (CLINT) and the interrupt controller (PLIC). Source: RISC-V
 * privileged architecture 1.12, 3.1 and 3.2; PLIC specification 1.0.0. A part adds its UART (uart.h), a board its numbers
 * (hal_board.h). */
#ifndef FIELDLING_RISCV_CORE_H
#define FIELDLING_RISCV_CORE_H

#include "check.h"

#define REG(address)  (*(volatile uint32_t *)(address))
#define REG8(address) (*(volatile uint8_t *)(address))

/* Interrupt `irq` of the controller has come. isr. Implemented by the part. */
void part_irq_isr(uint32_t irq);

/* Clocks, pins and devices of the part: from hal_init(), interrupts masked. Implemented by the part. */
void part_init(void);

/* All interrupts come by one trap, which masks the others: none interrupts another. */
void core_irq_enable(uint32_t irq);

/* main() has returned, or a fault has come (255): the image is a test, or broken. Does not return. Implemented by the board. */
void core_exit(int status) __attribute__((noreturn));

#endif
