/* PROFIBUS-DP slave: what an application sees of the station.
 *
 * Layer    fdl, fma -> [ddlm] -> application
 * Context  everything here is main, and must be called from one place: the main loop
 * Source   EN 50170-2 part 8 (DP), spec A6, A7
 *
 * An application, whole:
 *
 *     hal_init();
 *     ddlm_slave_init(hal_switches(), DDLM_BAUD_AUTO);
 *     hal_irq_restore(HAL_IRQ_ON);
 *     for (;;) {
 *         ddlm_poll();
 *         if (ddlm_outputs(out) != DDLM_OUT_SAME)
 *             drive_outputs(out);
 *         read_inputs(in);
 *         ddlm_inputs(in);
 *         hal_wdog_kick();
 *         hal_idle();
 *     }
 *
 * Promises, whatever comes over the wire:
 *  1 outputs are the octets of one good Data_Exchange of the owning master, or the fail-safe state; never a mixture
 *  2 a Data_Exchange is executed exactly once, however often the master repeats it
 *  3 no input, diagnosis or configuration leaves the station half old and half new
 *  4 without a living owner (watchdog, unlock, bad parameters, power-up) outputs are in the fail-safe state
 */
#ifndef FIELDLING_DDLM_H
#define FIELDLING_DDLM_H

#include "config.h"
#include "fdl/fma.h"

enum ddlm_state { DDLM_POWER_ON, DDLM_WAIT_PRM, DDLM_WAIT_CFG, DDLM_DATA_EXCH };

/* Watchdog states (EN 50170-2 part 8; facts 3.13). */
enum ddlm_wd_state { DDLM_BAUD_SEARCH, DDLM_BAUD_CONTROL, DDLM_DP_CONTROL };

#define DDLM_NO_MASTER 255u
#define DDLM_BAUD_AUTO 255u

/* Status values of the DDLM confirms (spec A6). */
enum ddlm_status { DDLM_OK, DDLM_IV, DDLM_NO, DDLM_DS, DDLM_NA, DDLM_RS, DDLM_RR, DDLM_UE, DDLM_NR, DDLM_TO, DDLM_FE,
                   DDLM_RE, DDLM_LE, DDLM_NI, DDLM_EA, DDLM_AD, DDLM_IP, DDLM_SC, DDLM_SE, DDLM_NE, DDLM_DI, DDLM_NC };

/* ---- station --------------------------------------------------------------------------------------------------- */

/* DDLM_Slave_Init: resets FMA and all below, takes the address (0..125 from switches: Set_Slave_Add is then
 * refused with RS; 126: the stored address, or 126 until a master sets one) and the rate (enum phy_baud, or
 * DDLM_BAUD_AUTO to search for it), activates the SAPs. Interrupts masked. -> DDLM_OK; DDLM_IV: no such address or
 * rate; DDLM_NO: the board cannot do that rate. Also raises ddlm_fault_ind() where it fails. */
uint8_t ddlm_slave_init(uint8_t switches, uint8_t baud);

/* One turn of the main loop: takes indications, watchdog, baud search, diagnosis. Bounded: at most FDL_BOXES
 * services. */
void ddlm_poll(void);

/* Forget the stored address and No_Add_Chg: a factory reset. Takes effect at the next ddlm_slave_init(). False: the
 * non-volatile memory does not store. */
bool ddlm_factory_reset(void);

/* ---- process data ---------------------------------------------------------------------------------------- */

/* Data_Exchange_Upd and RD_Inp_Upd: the inputs, all of them (ddlm_info.input_len octets). The first call after a good
 * Chk_Cfg declares input data ready. Under Freeze they wait for the next Freeze. Cheap to call every turn. */
void ddlm_inputs(const uint8_t XDATA *inputs);

/* Take the newest outputs: copies ddlm_info.output_len octets when there is something new.
 *   DDLM_OUT_SAME  nothing new, *outputs unchanged
 *   DDLM_OUT_NEW   outputs of one Data_Exchange (under Sync: of the last one before the Sync command)
 *   DDLM_OUT_SAFE  go to the fail-safe state (power-up, Clear, watchdog, unlock ...): outputs are 0 */
enum ddlm_out { DDLM_OUT_SAME, DDLM_OUT_NEW, DDLM_OUT_SAFE };
uint8_t ddlm_outputs(uint8_t XDATA *outputs);

/* ---- diagnosis ------------------------------------------------------------------------------------------- */

/* Slave_Diag_Upd: ext[0..len-1] are whole extended diagnosis blocks (device, identifier or channel related; spec
 * A6), what is longer than DEV_EXT_DIAG_MAX is cut and marked Ext_Diag_Overflow. flags: DDLM_EXT_DIAG the blocks
 * are a fault, not a status; DDLM_STAT_DIAG static: the master keeps reading until it is cleared. The owner is
 * told with the next Data_Exchange (DH). -> false: malformed blocks, nothing changed. */
#define DDLM_EXT_DIAG  0x01u
#define DDLM_STAT_DIAG 0x02u
bool ddlm_diag(const uint8_t XDATA *ext, uint8_t len, uint8_t flags);

/* ---- what the station is doing --------------------------------------------------------------------------- */

/* 16-bit counts wrap. */
struct ddlm_counters {
    uint16_t data_exchange;   /* executed, retries not included       */
    uint16_t global_control;  /* executed by this station             */
    uint16_t wrong_length;    /* Data_Exchange with the wrong length  */
    uint16_t prm_rejected;    /* Set_Prm that gave Prm_Fault          */
    uint16_t cfg_rejected;    /* Chk_Cfg that gave Cfg_Fault          */
    uint16_t not_processed;   /* acknowledged, but not in this state, or not from this master */
    uint16_t wd_expired;      /* watchdog expiries                    */
};

struct ddlm_info {
    uint8_t state;      /* enum ddlm_state                            */
    uint8_t wd_state;   /* enum ddlm_wd_state                         */
    uint8_t address;    /* station address                            */
    uint8_t master;     /* owner, or DDLM_NO_MASTER                   */
    uint8_t groups;     /* Group_Ident                                */
    uint8_t baud;       /* enum phy_baud in use                       */
    uint8_t min_t_sdr;  /* [T_bit]                                    */
    bool wd_on;
    bool sync_enabled;   /* Set_Prm asked for it */
    bool freeze_enabled;
    bool sync;           /* outputs are being held */
    bool freeze;         /* inputs are being held  */
    bool not_ready;      /* Station_Not_Ready      */
    bool address_locked; /* No_Add_Chg             */
    uint8_t input_len;
    uint8_t output_len;
    uint32_t wd_ms;      /* T_WD, 0 = off          */
};
void ddlm_read_info(struct ddlm_info XDATA *to);
void ddlm_read_counters(struct ddlm_counters XDATA *to);

/* ---- implemented by the application; defaults are in the library ----------------------------------------- */

/* User_Prm_Data of a Set_Prm whose other octets are good; len within DEV_USER_PRM_MIN..MAX. False: Prm_Fault.
 * Default: takes anything. */
bool ddlm_user_prm_ind(const uint8_t XDATA *prm, uint8_t len);

/* A configuration that is not the device's own: true takes it (its lengths are then read from the identifiers and
 * must fit DEV_INPUT_MAX and DEV_OUTPUT_MAX). Default: false. */
bool ddlm_adapt_cfg_ind(const uint8_t XDATA *cfg, uint8_t len);

/* The station changed state. Default: nothing. */
void ddlm_state_ind(uint8_t state);

/* An indication on a SAP the application activated itself (fma_sap_activate, fma_rsap_activate). Default: nothing. */
void ddlm_user_data_ind(const struct fdl_ind XDATA *ind);

/* DDLM_Fault: a management call failed, which only wrong software or hardware can cause. Default: nothing. */
void ddlm_fault_ind(uint8_t status);

#endif
