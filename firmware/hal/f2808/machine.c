/* Time, interrupts and pins. No console; non-volatile cells are the board's. */
#include "hal/f2808/machine.h"
#include "cpu.h"
#include "hal/line_uart.h"
#include "uart.h"

#define GPIO28_29_ARE_SCIA 0x0500u /* high half of GPAMUX2 */
#define WD_KEY_1 0x55u
#define WD_KEY_2 0xAAu

volatile bool f2808_interrupted;


static void init_timers(void)
{
    reg_set(TIMER0 + TPR, 0);
    reg_set(TIMER0 + TPRH, 0);
    reg_set(TIMER0 + TCR, TCR_STOP | TCR_FLAG);
    reg_set(TIMER1 + TPR, 0);
    reg_set(TIMER1 + TPRH, 0);
    reg_set(TIMER1 + PRD_LOW, 0xFFFF);
    reg_set(TIMER1 + PRD_HIGH, 0xFFFF);
    reg_set(TIMER1 + TCR, TCR_STOP | TCR_RELOAD);
    reg_set(TIMER1 + TCR, 0);
}

void hal_init(void)
{
    (void)cpu_mask();
    cpu_allow();
    reg_set(PCLKCR0, (uint16_t)(reg_get(PCLKCR0) | PCLK_SCIA));
    reg_set(GPACLEAR, BOARD_DRIVER_PIN);
    reg_set(GPADIR, (uint16_t)(reg_get(GPADIR) | BOARD_DRIVER_PIN));
    reg_set(GPAMUX2 + 1u, GPIO28_29_ARE_SCIA);
    cpu_protect();
    init_timers();
    cpu_vectors(f2808_timer0_isr, f2808_sci_rx_isr, f2808_sci_tx_isr);
    reg_set(PIEIER1, PIE_TIMER0);
    reg_set(PIEIER9, PIE_SCIRXA | PIE_SCITXA);
    reg_set(PIECTRL, 1);
}

uint8_t hal_irq_save(void)
{
    return cpu_mask() ? HAL_IRQ_ON : 0;
}

void hal_irq_restore(uint8_t state)
{
    if (state)
        cpu_unmask();
}

/* cpu_idle() ends with an interrupt, which then runs. */
void hal_idle(void)
{
    uint8_t irq = hal_irq_save();

    if (!f2808_interrupted) {
        line_uart_wake();
        cpu_idle();
        (void)cpu_mask();
    }
    f2808_interrupted = false;
    hal_irq_restore(irq);
    (void)hal_ticks();
}

void hal_wdog_kick(void)
{
    cpu_allow();
    reg_set(WDKEY, WD_KEY_1);
    reg_set(WDKEY, WD_KEY_2);
    cpu_protect();
}

void hal_reset(uint8_t why)
{
    cpu_restart(why);
}

int16_t hal_con_get(void)
{
    return -1;
}

void hal_con_put(uint8_t octet)
{
    (void)octet;
}
