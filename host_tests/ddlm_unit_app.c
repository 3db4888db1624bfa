#include "ddlm_unit.h"

struct unit_app XDATA app;

bool ddlm_user_prm_ind(const uint8_t XDATA *prm, uint8_t len)
{
    uint8_t i;

    app.prm_count++;
    app.prm_len = len;
    for (i = 0; i < len && i < sizeof app.prm; i++)
        app.prm[i] = prm[i];
    return app.prm_good;
}

bool ddlm_adapt_cfg_ind(const uint8_t XDATA *cfg, uint8_t len)
{
    (void)cfg;
    app.cfg_count++;
    app.cfg_len = len;
    if (app.while_adapting)
        app.while_adapting();
    return app.adapts;
}

void ddlm_state_ind(uint8_t state)
{
    app.states++;
    app.state = state;
}

void ddlm_fault_ind(uint8_t status)
{
    app.faults++;
    app.fault = status;
}

void ddlm_user_data_ind(const struct fdl_ind XDATA *ind)
{
    app.data_count++;
    app.data_sap = ind->dsap;
}
