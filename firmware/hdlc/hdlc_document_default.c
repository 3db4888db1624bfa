/* Taken when the application has none (hdlc_nrm.h). */
#include "hdlc/hdlc_nrm.h"

uint8_t hdlc_document_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer)
{
    (void)info;
    (void)n;
    (void)answer;
    return 0; /* silence */
}
