/* Default of an optional callback: alone in its object, so that the application's own replaces it. */
#include "ddlm/ddlm.h"

void ddlm_fault_ind(uint8_t status)
{
    (void)status;
}
