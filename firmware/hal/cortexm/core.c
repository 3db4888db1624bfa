#include "hal/cortexm/core.h"
#include "hal/line_uart.h"
#include "hal_board.h"
#include "uart.h"

#define SYST_CSR 0xE000E010u
#define SYST_RVR 0xE000E014u
#define SYST_CVR 0xE000E018u
#define SYST_ON_CORE_CLOCK 5u
#define SYST_TOP 0xFFFFFFu

#define AIRCR           0xE000ED0Cu
#define AIRCR_RESET_REQ 0x05FA0004u

volatile bool core_interrupted;

static uint32_t clocks;
static uint32_t last_count = SYST_TOP;

/* ---- time ------------------------------------------------------------------------------------------------ */

uint32_t core_clocks_isr(void)
{
    uint32_t count = REG(SYST_CVR);

    clocks += (last_count - count) & SYST_TOP;
    last_count = count;
    return clocks;
}

/* ---- machine --------------------------------------------------------------------------------------------- */

void hal_init(void)
{
    (void)hal_irq_save();
    REG(SYST_RVR) = SYST_TOP;
    REG(SYST_CVR) = 0;
    REG(SYST_CSR) = SYST_ON_CORE_CLOCK;
    part_init();
}

uint8_t hal_irq_save(void)
{
    uint32_t primask;

    __asm__ volatile("mrs %0, primask\n cpsid i" : "=r"(primask) : : "memory");
    return (uint8_t)((primask & 1u) ? 0u : HAL_IRQ_ON);
}

void hal_irq_restore(uint8_t state)
{
    if (state)
        __asm__ volatile("cpsie i" : : : "memory");
}

/* Sleep until an interrupt, unless one has come since the last time: the main loop may not have seen what it brought.
 * wfi ends with a pending interrupt even while masked, so nothing is missed between the look and the sleep; the interrupt
 * itself runs when it is let in. */
void hal_idle(void)
{
    uint8_t irq = hal_irq_save();

    if (!core_interrupted) {
        line_uart_wake();
        __asm__ volatile("wfi\n cpsie i\n isb\n cpsid i" : : : "memory");
    }
    core_interrupted = false;
    hal_irq_restore(irq);
    (void)hal_ticks();
}

/* ---- console --------------------------------------------------------------------------------------------- */

void hal_con_put(uint8_t octet)
{
    part_console_put(octet);
}

/* ---- reset ----------------------------------------------------------------------------------------------- */

void core_reset(void)
{
    REG(AIRCR) = AIRCR_RESET_REQ;
    for (;;) {
    }
}

void core_exit(int status)
{
    hal_reset((uint8_t)status);
    core_reset();
}
