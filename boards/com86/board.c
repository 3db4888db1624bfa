/* What is particular to COM86: no address switches, no hardware watchdog; a reset is the keyboard controller's. */
#include "hal/hal.h"
#include "hal/x86/pc.h"
#include "hal_board.h"

#define KEYBOARD_COMMAND 0x64u
#define PULSE_RESET      0xFEu

uint8_t hal_switches(void)
{
    return 126;
}

void hal_wdog_kick(void)
{
}

void hal_reset(uint8_t why)
{
    out8(BOARD_TEST_EXIT, why);
    out8(KEYBOARD_COMMAND, PULSE_RESET);
    for (;;)
        __asm__ volatile("cli; hlt");
}
