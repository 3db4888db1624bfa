/* Chk_Cfg: does the master expect the modules that are there? Get_Cfg: what is there.
 *
 * Identifiers are compared one by one, in order, empty slots included. An application may adapt to another
 * configuration (ddlm_adapt_cfg_ind). Chk_Cfg is always acknowledged; Cfg_Fault shows in the next Slave_Diag.
 * Source   EN 50170-2 part 8, Chk_Cfg, Get_Cfg; spec A6
 */
#include "ddlm/ddlm_cfg.h"
#include "ddlm/ddlm_priv.h"

static const CODE uint8_t own_cfg[] = {DEV_MODULES(DEV_IDENTIFIERS)};
#define OWN_LEN sizeof own_cfg

STATIC_ASSERT(sizeof own_cfg <= DEV_CFG_MAX, own_configuration_fits_DEV_CFG_MAX);

struct fdl_reply PAGED ddlm_cfg_reply;
static uint8_t XDATA rooms[3][FDL_ROOM(DEV_CFG_MAX)];
static uint8_t XDATA real_cfg[DEV_CFG_MAX]; /* what Get_Cfg says */
static uint8_t real_len;

/* real_cfg[] has been written: Get_Cfg_Upd. */
static void get_cfg_upd(uint8_t len, uint16_t input_len, uint16_t output_len)
{
    real_len = len;
    fdl_reply_write(&ddlm_cfg_reply, real_cfg, len, FDL_UPDATE_LOW);
    ddlm.input_len = (uint8_t)input_len;
    ddlm.output_len = (uint8_t)output_len;
}

static void use_own_cfg(void)
{
    uint8_t i;

    for (i = 0; i < OWN_LEN; i++)
        real_cfg[i] = own_cfg[i];
    get_cfg_upd(OWN_LEN, DEV_INPUT_LEN, DEV_OUTPUT_LEN);
}

void ddlm_cfg_init(void)
{
    fdl_reply_init(&ddlm_cfg_reply, rooms[0], DEV_CFG_MAX, SAP_GET_CFG);
    use_own_cfg();
}

static bool is_own(const uint8_t XDATA *cfg, uint8_t len)
{
    uint8_t i;

    if (len != OWN_LEN)
        return false;
    for (i = 0; i < OWN_LEN; i++)
        if (cfg[i] != own_cfg[i])
            return false;
    return true;
}

static bool is_real(const uint8_t XDATA *cfg, uint8_t len)
{
    uint8_t i;

    if (len != real_len)
        return false;
    for (i = 0; i < len; i++)
        if (cfg[i] != real_cfg[i])
            return false;
    return true;
}

static bool adapt(const uint8_t XDATA *cfg, uint8_t len)
{
    static struct ddlm_cfg_lengths XDATA lengths;
    uint8_t i;

    if (len > DEV_CFG_MAX || !ddlm_cfg_lengths(cfg, len, &lengths))
        return false;
    if (lengths.input > DEV_INPUT_MAX || lengths.output > DEV_OUTPUT_MAX || !ddlm_adapt_cfg_ind(cfg, len))
        return false;
    for (i = 0; i < len; i++)
        real_cfg[i] = cfg[i];
    get_cfg_upd(len, lengths.input, lengths.output);
    return true;
}

static bool accept(const uint8_t XDATA *cfg, uint8_t len)
{
    if (!is_own(cfg, len))
        return adapt(cfg, len);
    use_own_cfg();
    return true;
}

/* In DATA_EXCH the configuration is only checked again; a different one that the application adapts to begins
 * anew. Data exchange ends before that: Data_Exchange is checked against the lengths that are about to change. */
void ddlm_chk_cfg_ind(const struct fdl_ind XDATA *ind)
{
    bool running = ddlm.state == DDLM_DATA_EXCH;

    if (ddlm.master != ind->sa || (ddlm.state != DDLM_WAIT_CFG && !running)) {
        ddlm_counters.not_processed++;
        return;
    }
    if (running && is_real(ind->lsdu, ind->len))
        return;
    ddlm_leave();
    if (accept(ind->lsdu, ind->len)) {
        ddlm_set_state(DDLM_WAIT_CFG);
        ddlm.cfg_ok = true;
        ddlm_data_start();
        ddlm_slave_saps();
        ddlm_diag_update();
    } else {
        ddlm_counters.cfg_rejected++;
        ddlm.faults |= DIAG_CFG_FAULT;
        ddlm_leave_master();
    }
}
