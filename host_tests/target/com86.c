/* COM86 without its port, for tests of modules over the fake one: COM1 to write to, and an end. */
#include "hal/x86/pc.h"
#include "hal_board.h"

void target_put(char c);

void target_put(char c)
{
    out8(BOARD_CONSOLE_UART + UART_DATA, (uint8_t)c);
}

void pc_exit(int status)
{
    out8(BOARD_TEST_EXIT, (uint8_t)status);
    for (;;)
        __asm__ volatile("cli; hlt");
}

/* Nothing is ever unmasked. */
void pc_irq_isr(uint32_t irq)
{
    (void)irq;
}
