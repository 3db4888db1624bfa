/* expect: octet_isr: calls through a pointer, which may be in_main */
#include "check.h"

typedef uint8_t (*handler)(uint8_t octet) IN_ISR;

uint8_t octet_isr(uint8_t octet) IN_ISR;
uint8_t state_isr(uint8_t octet) IN_ISR;
uint8_t in_main(uint8_t octet) IN_ISR;

static const CODE handler handlers[2] = {state_isr, in_main};

uint8_t octet_isr(uint8_t octet) IN_ISR
{
    return handlers[octet & 1u](octet);
}
