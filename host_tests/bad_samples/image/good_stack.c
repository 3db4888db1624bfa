/* expect-nothing: what the simulator measures is what stack51.py computes, to the octet
 * measure: 600000 instructions
 * Two timers whose periods have no common factor break into every place of the main loop and of each other. */
#include <8052.h>
#include <stdint.h>

#include "check.h"

typedef uint16_t (*work)(uint16_t n);

void low_isr(void) __interrupt(1);
void high_isr(void) __interrupt(3) __using(2);
static volatile XDATA uint16_t result;
static volatile XDATA uint8_t text[3];

static uint16_t divided(uint16_t n)
{
    return n / (result | 1u); /* the library's __divuint */
}

static uint16_t summed(uint16_t n)
{
    const volatile uint8_t *p = text; /* __gptrget */

    return divided((uint16_t)(n + p[0] + p[n & 1u]));
}

static const CODE work works[2] = {divided, summed};

static void step_isr(void)
{
    text[1]++;
}

void low_isr(void) __interrupt(1)
{
    step_isr();
}

static void count_isr(void) __using(2)
{
    text[2]++;
}

void high_isr(void) __interrupt(3) __using(2)
{
    count_isr();
}

void main(void)
{
    uint8_t i = 0;

    TMOD = 0x22;
    TH0 = (uint8_t)(0u - 211u);
    TH1 = (uint8_t)(0u - 197u);
    TR0 = 1;
    TR1 = 1;
    IP = 0x08;
    IE = 0x8A;
    for (;;) {
        i++;
        result = works[i & 1u](i);
    }
}
