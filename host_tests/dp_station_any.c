/* A station of any configuration: inputs from dp_in, outputs to dp_out, takes every user parameter and, when
 * dp_adapts is set, every configuration. */
#include "dp_fixture.h"

bool dp_adapts;

void dp_station_init(uint8_t switches, uint8_t baud)
{
    ddlm_slave_init(switches, baud);
}

void dp_station_poll(void)
{
    ddlm_poll();
    dp_outs += ddlm_outputs(dp_out) != DDLM_OUT_SAME;
    ddlm_inputs(dp_in);
}

bool ddlm_adapt_cfg_ind(const uint8_t XDATA *cfg, uint8_t len)
{
    (void)cfg;
    (void)len;
    return dp_adapts;
}
