/* expect-nothing: keeps all rules, in the shapes that are hard to follow in assembly */
#include "hal/hal.h"

typedef uint8_t (*handler)(uint8_t octet) IN_ISR;

void octet_isr(uint8_t octet) IN_ISR;
void forget(void);
void main_loop(uint8_t n);
extern HOT uint8_t state;

static uint8_t wait_isr(uint8_t octet) IN_ISR
{
    return octet == 0x68u ? 1u : 0u;
}

static uint8_t body_isr(uint8_t octet) IN_ISR
{
    return (uint8_t)(octet >> 1);
}

static const CODE handler states[2] = {wait_isr, body_isr};

void forget(void)
{
    state = 0; /* bare: may be called from anywhere */
}

void octet_isr(uint8_t octet) IN_ISR
{
    state = states[state & 1u](octet);
    forget();
    hal_silence(33u);
}

void main_loop(uint8_t n)
{
    uint8_t irq = hal_irq_save();

    switch (n) {
    case 0:
        octet_isr(1);
        break;
    case 1:
        octet_isr(3);
        break;
    case 2:
        hal_irq_restore(irq);
        forget();
        return;
    case 3:
        state = 9;
        break;
    case 4:
        octet_isr(4);
        break;
    default:
        while (--n)
            octet_isr(n);
        break;
    }
    hal_irq_restore(irq);
}
