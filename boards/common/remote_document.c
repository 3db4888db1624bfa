/* The source document's mode: commands with control octet 08H before SNRM. Leave this file out, and a station is
 * silent there, as the standard wants it. */
#include "hdlc/hdlc_nrm.h"
#include "remote_module.h"

uint8_t hdlc_document_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer)
{
    return rm_execute(info, n, answer, true);
}
