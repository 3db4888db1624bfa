/* The port in virtual time knows a serial line as well; stations with an 8273 do not use it. */
#include "hal/hal.h"

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    (void)octet;
    (void)err;
}

void line_silence_isr(void) IN_ISR
{
}

void line_sent_isr(void) IN_ISR
{
}
