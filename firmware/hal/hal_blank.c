/* The empty port: links with every stack on every compiler, and is where a new port starts (README.md here).
 * Each body says what a real port does in its place. */
#include "hal.h"

void hal_init(void)
{
    /* clocks, pins (driver enable off first of all), timers, interrupt vectors; interrupts stay masked */
}

uint8_t hal_irq_save(void)
{
    return 0; /* read the mask, then mask */
}

void hal_irq_restore(uint8_t state)
{
    (void)state;
}

uint16_t hal_ticks(void)
{
    return 0; /* a counter the tick interrupt advances, or a free-running timer scaled to ms */
}

uint8_t hal_nv_read(uint8_t index)
{
    (void)index;
    return 0xFF;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    (void)index;
    (void)value;
    return false; /* true only after reading back */
}

uint8_t hal_switches(void)
{
    return 126;
}

void hal_wdog_kick(void)
{
}

void hal_idle(void)
{
    /* wfi, hlt, or nothing */
}

void hal_reset(uint8_t why)
{
    (void)why;
    for (;;) {
        /* let the hardware watchdog bite */
    }
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    (void)bit_per_s;
    (void)format;
    return HAL_LINE_NO; /* compute the divisor; refuse what is off by more than the standard allows */
}

hal_dur_t hal_tbit(uint16_t n)
{
    return n;
}

void hal_silence(hal_dur_t d) IN_ISR
{
    (void)d; /* compare (end of last octet + d) with the running timer: program the rest, or pend the interrupt */
}

bool hal_silent(hal_dur_t d) IN_ISR
{
    (void)d;
    return false; /* as long as the interrupt that hal_silence() pends is no later */
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    (void)octets; /* driver on, first octet out; the transmit interrupt or DMA does the rest */
    (void)n;
}

int16_t hal_con_get(void)
{
    return -1;
}

void hal_con_put(uint8_t octet)
{
    (void)octet;
}
