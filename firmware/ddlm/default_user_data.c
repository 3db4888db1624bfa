/* Default of an optional callback: alone in its object, so that the application's own replaces it. */
#include "ddlm/ddlm.h"

void ddlm_user_data_ind(const struct fdl_ind XDATA *ind)
{
    (void)ind;
}
