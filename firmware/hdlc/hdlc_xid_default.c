/* Taken when the application has none (hdlc_nrm.h). */
#include "hdlc/hdlc_nrm.h"

uint8_t hdlc_xid_ind(uint8_t XDATA *answer)
{
    (void)answer;
    return 0;
}
