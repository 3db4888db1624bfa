/* FMA1/2, management of layers 1 and 2: what DDLM (and a console) uses to set up PHY and FDL.
 *
 * Layer    [fma] over phy_uart and fdl; implements phy_event_ind
 * Context  everything here is main
 * Source   EN 50170-2 part 3 and 4, FMA1/2; spec A5
 */
#ifndef FIELDLING_FMA_H
#define FIELDLING_FMA_H

#include "fdl/fdl.h"

/* M_status of the confirms. */
enum fma_status {
    FMA_OK,
    FMA_NO, /* this hardware cannot                         */
    FMA_IV, /* no such variable, value, SAP or parameter     */
    FMA_LR, /* local resource missing: no SAP row free       */
    FMA_LS, /* SAP not active                                */
    FMA_RS, /* remote SAP not active (not used by a slave)   */
    FMA_NA, /* no answer (not used by a slave)               */
    FMA_NR  /* no data to read                               */
};

enum fma_variable {
    FMA_TS,             /* station address 0..126                              */
    FMA_BAUD_RATE,      /* enum phy_baud                                       */
    FMA_MEDIUM_RED,     /* enum phy_medium                                     */
    FMA_TRANSMITTER,    /* PHY Transmitter_output                              */
    FMA_SIGNAL_SOURCE,  /* PHY Received_signal_source                          */
    FMA_LOOP,           /* PHY Loop                                            */
    FMA_T_SL,           /* slot time [T_bit], 37..16383                        */
    FMA_MIN_T_SDR,      /* [T_bit], 11..255                                    */
    FMA_SD_COUNT,       /* good start delimiters; can be set to 0 only         */
    FMA_SD_ERROR_COUNT, /* invalid ones; can be set to 0 only                  */
    FMA_VARIABLES       /* HW-Release and SW-Release are strings: fma_ident()  */
};

/* FMA1/2 Reset: PHY_RESET, FDL reset with every SAP deactivated, T_SL 100, min_T_SDR 11, station address ts. */
uint8_t fma_reset(uint8_t ts);

/* FMA1/2 Set Value / Read Value -> enum fma_status; *value is unchanged unless FMA_OK. */
uint8_t fma_set_value(uint8_t variable, uint16_t value);
uint8_t fma_read_value(uint8_t variable, uint16_t XDATA *value);

/* FMA1/2 Ident of this station: Vendor_name, Controller_type, HW_release, SW_release as four length octets and the
 * four strings without terminators, at most 64 octets into `to` -> length. */
uint8_t fma_ident(uint8_t XDATA *to);

/* FMA1/2 LSAP Status of a local SAP -> FMA_OK with *to filled, FMA_LS, FMA_IV. */
uint8_t fma_lsap_status(uint8_t sap, struct fdl_sap PAGED *to);

/* FMA1/2 SAP Activate: a SAP that acknowledges SDA and takes SDN (services = FDL_SDA | FDL_SDN, or one of them).
 * RSAP Activate: a SAP that answers SRD from `reply` (0: with SC). access 0..126 or FDL_ALL; max_len of the request's
 * L_sdu; handling enum fdl_handling. Activating an active SAP changes it. -> FMA_OK, FMA_IV, FMA_LR. */
uint8_t fma_sap_activate(uint8_t sap, uint8_t access, uint8_t services, uint8_t max_len, uint8_t handling);
uint8_t fma_rsap_activate(uint8_t sap, uint8_t access, uint8_t max_len, uint8_t handling,
                          struct fdl_reply PAGED *reply);

/* FMA1/2 SAP Deactivate -> FMA_OK, FMA_LS (was not active), FMA_IV. */
uint8_t fma_sap_deactivate(uint8_t sap);

/* Watches for FDL faults; call it from the main loop with the time since the last call [ms]. */
void fma_poll(uint16_t elapsed_ms);

/* FMA1/2 Event.indication; implemented by the layer above (default: nothing). */
enum fma_event {
    FMA_EVENT_PHY,      /* a PHY variable changed: detail = enum phy_variable                             */
    FMA_EVENT_TIME_OUT, /* nothing heard for T_TO                                                         */
    FMA_EVENT_NOT_SYN   /* octets are heard, but none of them begins a telegram: detail = low octet of SD_error_count */
};
void fma_event_ind(uint8_t event, uint8_t detail);

#endif
