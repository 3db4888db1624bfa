/* Machine services: start, lock, milliseconds, watchdog, reset. */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

#define T1_T0_16_BIT 0x11u /* TMOD */
#define PRIORITY_LINE 0x12u /* IP: serial port and Timer 0 interrupt everything else */

volatile HOT uint8_t overflows; /* of Timer 1 */

/* The millisecond that was counted last began here. */
static uint8_t seen_overflows;
static uint16_t seen_cycles;
static uint16_t ms;

/* Timer 1, with the overflows before it. */
static uint8_t turns;
static uint16_t cycles;

#define CYCLES_PER_MS ((uint16_t)(CYCLES_PER_S / 1000u))
STATIC_ASSERT(FOSC_HZ >= 6000000ul && FOSC_HZ <= 48000000ul, fosc_fits_the_millisecond_arithmetic);

void hal_init(void)
{
    DRIVER_OFF();
    P2 = 0; /* the page of PAGED: the linker puts it first */
    EA = 0;
    TMOD = T1_T0_16_BIT;
    TR1 = 1;
    IP = PRIORITY_LINE;
    IT1 = 1; /* IE1 stays until the service has been entered */
    ET1 = 1;
}

/* The lock masks the service: see mcs51.h. */
uint8_t hal_irq_save(void)
{
    uint8_t was = EX1;

    EX1 = 0;
    return was;
}

void hal_irq_restore(uint8_t state)
{
    if (!state)
        return;
    EA = 1;
    EX1 = 1;
}

void tick_timer_isr(void) __interrupt(3) __naked
{
    __asm
        inc _overflows
        reti
    __endasm;
}

static void read_timer_1(void)
{
    uint8_t high;

    do {
        turns = overflows;
        high = TH1;
        cycles = (uint16_t)(((uint16_t)high << 8) | TL1);
    } while (high != TH1 || turns != overflows);
}

static bool millisecond_is_over(void)
{
    uint16_t elapsed = (uint16_t)(cycles - seen_cycles);
    uint8_t wraps = (uint8_t)(turns - seen_overflows);

    if (cycles < seen_cycles)
        wraps--;
    return wraps || elapsed >= CYCLES_PER_MS;
}

/* Exact as long as it is called within 256 overflows: 16 s at 12 MHz. */
uint16_t hal_ticks(void)
{
    read_timer_1();
    while (millisecond_is_over()) {
        ms++;
        seen_cycles = (uint16_t)(seen_cycles + CYCLES_PER_MS);
        if (seen_cycles < CYCLES_PER_MS)
            seen_overflows++;
    }
    return ms;
}

uint8_t hal_switches(void)
{
    return SWITCHES();
}

void hal_wdog_kick(void)
{
    WDOG_KICK();
}

/* our choice: no sleep. Inputs are read and times looked at each turn, and nothing else would wake the core. */
void hal_idle(void)
{
}

/* Two returns from interrupt, so that neither level is in service any more, the second one to address 0. */
void hal_reset(uint8_t why)
{
    (void)why;
    EA = 0;
    DRIVER_OFF();
    __asm
        mov dptr,#00001$
        push dpl
        push dph
        reti
    00001$:
        clr a
        mov psw,a
        push acc
        push acc
        reti
    __endasm;
}
