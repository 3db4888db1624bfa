/* expect: octet_isr: selects the main loop's registers for later_isr */
#include "check.h"

void octet_isr(uint8_t octet) IN_ISR;
void later_isr(uint8_t octet); /* IN_ISR is missing */

void octet_isr(uint8_t octet) IN_ISR
{
    later_isr(octet);
}
