/* expect: first_isr: calls SDCC's helper _gptrget */
#include "check.h"

uint8_t first_isr(const uint8_t *p) IN_ISR;

uint8_t first_isr(const uint8_t *p) IN_ISR /* a plain pointer: XDATA is missing */
{
    return p[0];
}
