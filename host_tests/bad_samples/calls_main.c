/* expect: octet_isr: calls count, which is not interrupt code */
#include "check.h"

void octet_isr(uint8_t octet) IN_ISR;
void count(uint8_t octet);

void octet_isr(uint8_t octet) IN_ISR
{
    count(octet);
}
