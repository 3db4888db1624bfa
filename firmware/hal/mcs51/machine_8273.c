/* The port for 8052 cores whose line is an 8273: RxINT and TxINT through inverters on INT0 and INT1, levels; Timer 0
 * every millisecond. The lock masks interrupts: an octet at 7200 bit/s lasts 1111 machine cycles at 12 MHz, and
 * locked sections are far shorter. All three interrupts have one priority and register bank 1. */
#include "hal/hal.h"
#include "hal/hal_8273.h"
#include "hal/mcs51/machine_8273.h"

#define CYCLES_PER_MS (FOSC_HZ / 12000u)
#define T0_16_BIT     0x01u /* TMOD */
#define RELOAD_CYCLES 8u    /* Timer 0 stands still while it is set */

static volatile uint16_t ms;

void hal_init(void)
{
    EA = 0;
    TMOD = T0_16_BIT;
    TR0 = 1;
    IT0 = 0;
    IT1 = 0;
    EX0 = 1;
    EX1 = 1;
    ET0 = 1;
}

uint8_t hal_irq_save(void)
{
    const uint8_t was = EA;
    EA = 0;
    return was;
}

void hal_irq_restore(uint8_t state)
{
    EA = state != 0;
}

void rx_interrupt_isr(void) __interrupt(0) __using(1)
{
    chip_rx_isr();
}

void tx_interrupt_isr(void) __interrupt(2) __using(1)
{
    chip_tx_isr();
}

/* What has passed since the overflow is in the timer: it is added to. */
void timer_interrupt_isr(void) __interrupt(1) __using(1)
{
    uint16_t next;

    TR0 = 0;
    next = (uint16_t)(((uint16_t)TH0 << 8 | TL0) - (CYCLES_PER_MS - RELOAD_CYCLES));
    TH0 = (uint8_t)(next >> 8);
    TL0 = (uint8_t)next;
    TR0 = 1;
    ms++;
    board_tick_isr();
}

uint16_t hal_ticks(void)
{
    const uint8_t was = hal_irq_save();
    const uint16_t now = ms;
    hal_irq_restore(was);
    return now;
}

uint8_t hal_switches(void)
{
    return SWITCHES();
}

void hal_wdog_kick(void)
{
    WDOG_KICK();
}

/* our choice: no sleep, the background checks use what time there is. */
void hal_idle(void)
{
}

void hal_reset(uint8_t why)
{
    (void)why;
    EA = 0;
    for (;;) {
        /* the watchdog bites */
    }
}
