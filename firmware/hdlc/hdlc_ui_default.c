/* Taken when the application has none (hdlc_nrm.h). */
#include "hdlc/hdlc_nrm.h"

void hdlc_ui_ind(const uint8_t XDATA *info, uint8_t n)
{
    (void)info;
    (void)n;
}
