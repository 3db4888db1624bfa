/* Default of an optional callback: alone in its object, so that the application's own replaces it. */
#include "ddlm/ddlm.h"

bool ddlm_user_prm_ind(const uint8_t XDATA *prm, uint8_t len)
{
    (void)prm;
    (void)len;
    return true;
}
