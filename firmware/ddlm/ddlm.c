/* The slave's state machine and its service table.
 *
 * Source   EN 50170-2 part 8, slave state machine; spec A6, A7; service by state: facts 3.6
 */
#include "ddlm/ddlm_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

IDATA struct ddlm ddlm;
struct ddlm_counters XDATA ddlm_counters;

static uint16_t last_tick;

/* ---- service table --------------------------------------------------------------------------------------- */

/* In which states a SAP is active; elsewhere FDL answers RS. */
#define IN_POWER_ON  0x01u
#define IN_WAIT_PRM  0x02u
#define IN_WAIT_CFG  0x04u
#define IN_DATA_EXCH 0x08u
#define IN_ALL       0x0Fu
#define IN_WAITING   (IN_WAIT_PRM | IN_WAIT_CFG | IN_DATA_EXCH)

enum reply_of { NO_REPLY, CFG_REPLY, DIAG_REPLY, INPUT_REPLY, RD_OUTP_REPLY };

/* Set_Slave_Add and Chk_Cfg are acknowledged wherever their SAP is active; whether they are processed is their
 * handler's business. Set_Slave_Add stays active so that a retry is acknowledged like the first.
 * our choice: RD_Inp is answered from Data_Exchange's own buffer, always the same inputs, and with its priority: DH while
 * a diagnosis is pending. */
struct service {
    uint8_t sap;
    uint8_t states;
    uint8_t max_len; /* of the request's L_sdu; longer: RR */
    uint8_t handling;
    uint8_t reply;
    bool owner_only;
};

#define ANY_LEN 246u
#define SERVICES 9u
static const CODE struct service services[SERVICES] = {
    /* sap                 active in     max_len  handling         answered from   owner only */
    {SAP_SET_SLAVE_ADD,    IN_ALL,       ANY_LEN, FDL_TO_MAIN,     NO_REPLY,       false},
    {SAP_RD_INP,           IN_DATA_EXCH, 0,       FDL_ANSWER_ONLY, INPUT_REPLY,    false},
    {SAP_RD_OUTP,          IN_DATA_EXCH, 0,       FDL_ANSWER_ONLY, RD_OUTP_REPLY,  false},
    {SAP_GLOBAL_CONTROL,   IN_DATA_EXCH, 2,       FDL_TO_ISR,      NO_REPLY,       true},
    {SAP_GET_CFG,          IN_ALL,       0,       FDL_ANSWER_ONLY, CFG_REPLY,      false},
    {SAP_SLAVE_DIAG,       IN_ALL,       0,       FDL_TO_ISR,      DIAG_REPLY,     false},
    {SAP_SET_PRM,          IN_WAITING,   ANY_LEN, FDL_TO_MAIN,     NO_REPLY,       false},
    {SAP_CHK_CFG,          IN_WAITING,   ANY_LEN, FDL_TO_MAIN,     NO_REPLY,       false},
    {FDL_SAP_NIL,          IN_DATA_EXCH, ANY_LEN, FDL_TO_ISR,      INPUT_REPLY,    true},
};

static struct fdl_reply PAGED *reply_at(uint8_t which)
{
    switch (which) {
    case CFG_REPLY:
        return &ddlm_cfg_reply;
    case DIAG_REPLY:
        return &ddlm_diag_reply;
    case INPUT_REPLY:
        return &ddlm_input_reply;
    case RD_OUTP_REPLY:
        return &ddlm_rd_outp_reply;
    default:
        return 0;
    }
}

static uint8_t activate(const CODE struct service *service)
{
    uint8_t access = service->owner_only ? ddlm.master : FDL_ALL;

    if (service->sap == SAP_GLOBAL_CONTROL)
        return fma_sap_activate(service->sap, access, FDL_SDN, service->max_len, service->handling);
    return fma_rsap_activate(service->sap, access, service->max_len, service->handling, reply_at(service->reply));
}

uint8_t ddlm_variable(uint8_t variable)
{
    static uint16_t XDATA value;

    ddlm_check_fma(fma_read_value(variable, &value));
    return (uint8_t)value;
}

void ddlm_check_fma(uint8_t m_status)
{
    if (m_status != FMA_OK)
        ddlm_fault_ind(m_status == FMA_NO ? DDLM_NO : m_status == FMA_LR ? DDLM_RE : DDLM_IV);
}

void ddlm_slave_saps(void)
{
    const uint8_t here = (uint8_t)(1u << ddlm.state);
    uint8_t i;

    for (i = 0; i < SERVICES; i++) {
        if (services[i].sap == SAP_SET_SLAVE_ADD && (!DEV_SET_SLAVE_ADD || ddlm.by_switches))
            continue;
        if (services[i].states & here)
            ddlm_check_fma(activate(&services[i]));
        else
            fma_sap_deactivate(services[i].sap);
    }
}

void fdl_data_ind(const struct fdl_ind XDATA *ind)
{
    switch (ind->dsap) {
    case SAP_SET_PRM:
        ddlm_set_prm_ind(ind);
        break;
    case SAP_CHK_CFG:
        ddlm_chk_cfg_ind(ind);
        break;
    case SAP_SET_SLAVE_ADD:
        ddlm_set_slave_add_ind(ind);
        break;
    default:
        ddlm_user_data_ind(ind);
        break;
    }
}

/* ---- state machine --------------------------------------------------------------------------------------- */

/* The only writer of the state, and the one place to trace. */
void ddlm_set_state(uint8_t state)
{
    ASSERT(state != DDLM_DATA_EXCH || ddlm.state == DDLM_WAIT_CFG);
    ASSERT(state != DDLM_WAIT_CFG || ddlm.state != DDLM_POWER_ON);
    if (ddlm.state == state)
        return;
    ddlm.state = state;
    ddlm_state_ind(state);
}

void ddlm_enter(void)
{
    ddlm_set_state(DDLM_DATA_EXCH);
    ddlm_slave_saps();
}

/* Order matters: no Data_Exchange may slip in between the fail-safe outputs and the deactivation. */
void ddlm_leave(void)
{
    fma_sap_deactivate(FDL_SAP_NIL);
    fma_sap_deactivate(SAP_GLOBAL_CONTROL);
    ddlm_data_safe();
}

/* Nobody's station: what Set_Prm and Chk_Cfg brought is gone. */
static void forget_master(void)
{
    ddlm.master = DDLM_NO_MASTER;
    ddlm.groups = 0;
    ddlm.sync_enabled = false;
    ddlm.freeze_enabled = false;
    ddlm.cfg_ok = false;
}

void ddlm_leave_master(void)
{
    ddlm_leave();
    forget_master();
    fdl_watch(FDL_ALL);
    ddlm_wd_off();
    ddlm_set_state(DDLM_WAIT_PRM);
    ddlm_slave_saps();
    ddlm_diag_update();
}

void ddlm_set_min_tsdr(uint8_t tbit)
{
    ddlm_check_fma(fma_set_value(FMA_MIN_T_SDR, tbit));
}

uint8_t ddlm_slave_init(uint8_t switches, uint8_t baud)
{
    static uint8_t XDATA ident[64];
    uint8_t i;
    uint8_t status;

    if (switches > FDL_UNADDRESSED || (baud != DDLM_BAUD_AUTO && baud >= PHY_BAUDS)) {
        ddlm_fault_ind(DDLM_IV);
        return DDLM_IV;
    }
    ddlm.by_switches = switches < FDL_UNADDRESSED;
    ddlm.address = ddlm.by_switches ? switches : ddlm_stored_address();
    ddlm.locked = !ddlm.by_switches && ddlm_stored_lock();
    ddlm.state = DDLM_POWER_ON;
    ddlm.faults = 0;
    forget_master();
    for (i = 0; i < sizeof ddlm_counters; i++)
        ((uint8_t XDATA *)&ddlm_counters)[i] = 0;
    ddlm_check_fma(fma_reset(ddlm.address));
    fdl_set_ident(ident, fma_ident(ident));
    ddlm_cfg_init();
    ddlm_data_init();
    ddlm_diag_init();
    ddlm_wd_init(baud);
    last_tick = hal_ticks();
    status = ddlm_variable(FMA_BAUD_RATE) < PHY_BAUDS ? DDLM_OK : DDLM_NO;
    if (status != DDLM_OK)
        ddlm_fault_ind(status);
    if (ddlm.address == FDL_UNADDRESSED)
        ddlm_slave_saps(); /* stays in POWER_ON until Set_Slave_Add */
    else
        ddlm_leave_master();
    ddlm_diag_update();
    return status;
}

void ddlm_poll(void)
{
    uint16_t now = hal_ticks();
    uint16_t elapsed = (uint16_t)(now - last_tick);
    uint8_t heard = fdl_heard();

    last_tick = now;
    ddlm_wd_poll(elapsed, heard); /* first: a watchdog set below must not be charged for the time before */
    fma_poll(elapsed);
    ddlm_data_poll();
    fdl_poll();
}

void ddlm_read_info(struct ddlm_info XDATA *to)
{
    to->state = ddlm.state;
    to->wd_state = ddlm_wd_state();
    to->address = ddlm.address;
    to->master = ddlm.master;
    to->groups = ddlm.groups;
    to->baud = ddlm_variable(FMA_BAUD_RATE);
    to->min_t_sdr = ddlm_variable(FMA_MIN_T_SDR);
    to->wd_on = ddlm_wd_on();
    to->sync_enabled = ddlm.sync_enabled;
    to->freeze_enabled = ddlm.freeze_enabled;
    to->sync = ddlm_sync_mode();
    to->freeze = ddlm_freeze_mode();
    to->not_ready = ddlm.state != DDLM_DATA_EXCH;
    to->address_locked = ddlm.locked;
    to->input_len = ddlm.input_len;
    to->output_len = ddlm.output_len;
    to->wd_ms = ddlm_wd_ms();
}

void ddlm_read_counters(struct ddlm_counters XDATA *to)
{
    uint8_t irq = hal_irq_save();

    *to = ddlm_counters;
    hal_irq_restore(irq);
}
