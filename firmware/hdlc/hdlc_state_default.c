/* Taken when the application has none (hdlc_nrm.h). */
#include "hdlc/hdlc_nrm.h"

void hdlc_state_ind(uint8_t state)
{
    (void)state;
}
