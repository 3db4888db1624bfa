/* Default of an optional callback: alone in its object, so that the application's own replaces it. */
#include "ddlm/ddlm.h"

bool ddlm_adapt_cfg_ind(const uint8_t XDATA *cfg, uint8_t len)
{
    (void)cfg;
    (void)len;
    return false;
}
