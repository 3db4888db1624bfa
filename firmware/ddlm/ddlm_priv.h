/* What the files of this folder share. */
#ifndef FIELDLING_DDLM_PRIV_H
#define FIELDLING_DDLM_PRIV_H

#include "ddlm/ddlm.h"

/* Slave SAPs (spec A6). */
enum ddlm_sap {
    SAP_SET_SLAVE_ADD = 55, SAP_RD_INP, SAP_RD_OUTP, SAP_GLOBAL_CONTROL,
    SAP_GET_CFG, SAP_SLAVE_DIAG, SAP_SET_PRM, SAP_CHK_CFG
};

/* Octet 1 and 2 of Slave_Diag. */
#define DIAG_NOT_READY     0x02u
#define DIAG_CFG_FAULT     0x04u
#define DIAG_EXT_DIAG      0x08u
#define DIAG_NOT_SUPPORTED 0x10u
#define DIAG_PRM_FAULT     0x40u
#define DIAG2_PRM_REQ      0x01u
#define DIAG2_STAT_DIAG    0x02u
#define DIAG2_ALWAYS       0x04u
#define DIAG2_WD_ON        0x08u
#define DIAG2_FREEZE       0x10u
#define DIAG2_SYNC         0x20u
#define DIAG3_OVERFLOW     0x80u

/* The machine. Written by the main loop only.
 * Invariants: master != DDLM_NO_MASTER exactly in WAIT_CFG and DATA_EXCH; faults is a subset of DIAG_CFG_FAULT |
 * DIAG_NOT_SUPPORTED | DIAG_PRM_FAULT; input_len <= DEV_INPUT_MAX, output_len <= DEV_OUTPUT_MAX. */
struct ddlm {
    uint8_t state;
    uint8_t address;
    uint8_t master;
    uint8_t groups;
    uint8_t faults;      /* DIAG_* that stay until the next good Set_Prm      */
    uint8_t by_switches;    /* address comes from switches                       */
    uint8_t locked;         /* No_Add_Chg                                         */
    uint8_t sync_enabled;
    uint8_t freeze_enabled;
    uint8_t cfg_ok;         /* Chk_Cfg was good, inputs are awaited              */
    uint8_t input_len;
    uint8_t output_len;
};
extern IDATA struct ddlm ddlm;
extern struct ddlm_counters XDATA ddlm_counters;

/* ---- ddlm.c ---- */
void ddlm_set_state(uint8_t state);
void ddlm_leave_master(void);             /* to WAIT_PRM: fail-safe outputs, no owner                    */
void ddlm_enter(void);                    /* DDLM_Enter: data SAP and Global_Control active for the owner */
void ddlm_leave(void);                    /* DDLM_Leave: deactivated again                                */
void ddlm_set_min_tsdr(uint8_t tbit);     /* DDLM_Set_minTsdr                                             */
void ddlm_check_fma(uint8_t m_status);    /* anything but OK raises ddlm_fault_ind()                       */
uint8_t ddlm_variable(uint8_t variable);  /* FMA Read Value of an FMA variable that fits an octet         */
void ddlm_slave_saps(void);               /* the SAPs a slave answers on in its present state              */

/* ---- services, main: one indication each ---- */
void ddlm_set_prm_ind(const struct fdl_ind XDATA *ind);
void ddlm_chk_cfg_ind(const struct fdl_ind XDATA *ind);
void ddlm_set_slave_add_ind(const struct fdl_ind XDATA *ind);

/* ---- ddlm_cfg.c ---- */
extern struct fdl_reply PAGED ddlm_cfg_reply;
void ddlm_cfg_init(void);

/* ---- ddlm_addr.c: address in non-volatile memory ---- */
uint8_t ddlm_stored_address(void);        /* 0..125, or 126 where none is stored */
bool ddlm_stored_lock(void);

/* ---- ddlm_diag.c ---- */
extern struct fdl_reply PAGED ddlm_diag_reply;
void ddlm_diag_init(void);
void ddlm_diag_update(void);              /* something Slave_Diag shows has changed */
void ddlm_diag_ask_isr(void) IN_ISR;      /* a master is about to read it, and a box waits */
void ddlm_diag_read_isr(void) IN_ISR;     /* it has read it                         */

/* ---- ddlm_data.c: Data_Exchange and Global_Control ---- */
extern struct fdl_reply PAGED ddlm_input_reply;
extern struct fdl_reply PAGED ddlm_rd_outp_reply;
void ddlm_data_init(void);
void ddlm_data_start(void);               /* a new configuration: no inputs yet, outputs fail-safe      */
void ddlm_data_safe(void);                /* outputs fail-safe, Sync and Freeze off                     */
void ddlm_data_poll(void);                /* what the interrupt noted for the main loop                 */
bool ddlm_sync_mode(void);
bool ddlm_freeze_mode(void);

/* ---- ddlm_wd.c ---- */
void ddlm_wd_init(uint8_t baud);          /* enum phy_baud, DDLM_BAUD_AUTO */
void ddlm_wd_set(uint8_t fact_1, uint8_t fact_2); /* DP_CONTROL: 10 ms * fact_1 * fact_2, both 1..255 */
void ddlm_wd_off(void);
void ddlm_wd_poll(uint16_t elapsed_ms, uint8_t heard);
bool ddlm_wd_on(void);
uint8_t ddlm_wd_state(void);
uint32_t ddlm_wd_ms(void);

#endif
