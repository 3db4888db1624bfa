/* expect: scale_isr: calls SDCC's helper _mulint */
#include "check.h"

uint16_t scale_isr(uint16_t n) IN_ISR;

uint16_t scale_isr(uint16_t n) IN_ISR
{
    return (uint16_t)(n * 11u);
}
