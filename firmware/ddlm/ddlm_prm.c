/* Set_Prm: a master takes the station, gives it up, or changes min_T_SDR.
 *
 *   octet 1  Lock_Req Unlock_Req Sync_Req Freeze_Req WD_On 0 0 0
 *   octet 2  WD_Fact_1   3  WD_Fact_2   4  min_T_SDR   5, 6  Ident_Number   7  Group_Ident   8...  User_Prm_Data
 *
 * Set_Prm is always acknowledged; what was wrong shows in the next Slave_Diag.
 * Source   EN 50170-2 part 8, Set_Prm; spec A6; facts 3.7
 */
#include "bytes.h"
#include "ddlm/ddlm_priv.h"
#include "phy_uart/phy_uart.h"

#define LOCK   0x80u
#define UNLOCK 0x40u
#define SYNC   0x20u
#define FREEZE 0x10u
#define WD_ON  0x08u

#define PRM_LEN   7u /* octets 1..7 */
#define T_SDR_MIN 11u

static const uint8_t XDATA *prm;
static uint8_t len;

static void reject(uint8_t faults)
{
    ddlm_counters.prm_rejected++;
    ddlm.faults = faults;
    ddlm_leave_master();
}

static const CODE uint8_t unsupported = (DEV_SYNC ? 0 : SYNC) | (DEV_FREEZE ? 0 : FREEZE);

static uint8_t fault_in_request(void)
{
    uint8_t status = prm[0];

    if (get_u16be(prm + 4) != DEV_IDENT)
        return DIAG_PRM_FAULT;
    if (len < PRM_LEN + DEV_USER_PRM_MIN || len > PRM_LEN + DEV_USER_PRM_MAX)
        return DIAG_PRM_FAULT;
    if (status & unsupported)
        return DIAG_PRM_FAULT | DIAG_NOT_SUPPORTED;
    if ((status & WD_ON) && (prm[1] == 0 || prm[2] == 0))
        return DIAG_PRM_FAULT;
    if (prm[3] != 0 && (prm[3] < T_SDR_MIN || prm[3] > phy_max_t_sdr(ddlm_variable(FMA_BAUD_RATE))))
        return DIAG_PRM_FAULT;
    if (!ddlm_user_prm_ind(prm + PRM_LEN, (uint8_t)(len - PRM_LEN)))
        return DIAG_PRM_FAULT;
    return 0;
}

/* Lock_Req: all parameters are taken over. */
static void take(uint8_t master)
{
    uint8_t faults = fault_in_request();

    if (faults) {
        reject(faults);
        return;
    }
    ddlm_leave();
    ddlm.faults = 0;
    ddlm.master = master;
    ddlm.cfg_ok = false;
    ddlm.sync_enabled = (prm[0] & SYNC) != 0;
    ddlm.freeze_enabled = (prm[0] & FREEZE) != 0;
    ddlm.groups = prm[6];
    if (prm[3])
        ddlm_set_min_tsdr(prm[3]);
    fdl_watch(master);
    if (prm[0] & WD_ON)
        ddlm_wd_set(prm[1], prm[2]);
    else
        ddlm_wd_off();
    ddlm_set_state(DDLM_WAIT_CFG);
    ddlm_slave_saps();
    ddlm_diag_update();
}

/* Neither Lock nor Unlock: only min_T_SDR may change, whatever the ident; 0 keeps it. our choice: a value that is not
 * allowed is ignored, since nothing else of this Set_Prm may change either. */
static void change_min_tsdr(void)
{
    if (prm[3] >= T_SDR_MIN && prm[3] <= phy_max_t_sdr(ddlm_variable(FMA_BAUD_RATE)))
        ddlm_set_min_tsdr(prm[3]);
}

void ddlm_set_prm_ind(const struct fdl_ind XDATA *ind)
{
    prm = ind->lsdu;
    len = ind->len;
    if (ddlm.state == DDLM_POWER_ON || (ddlm.master != DDLM_NO_MASTER && ddlm.master != ind->sa)) {
        ddlm_counters.not_processed++; /* locked to another master */
    } else if (len < PRM_LEN || ((prm[0] & UNLOCK) && get_u16be(prm + 4) != DEV_IDENT)) {
        reject(DIAG_PRM_FAULT);
    } else if (prm[0] & UNLOCK) {
        ddlm.faults = 0;
        ddlm_leave_master();
    } else if (prm[0] & LOCK) {
        take(ind->sa);
    } else {
        change_min_tsdr();
    }
}
