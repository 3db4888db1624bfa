/* HDLC secondary, unbalanced operation, normal response mode (UNC), modulo 8, window 1.
 *
 * Layer    hdlc_8273 -> [hdlc_nrm] -> application (boards/common/remote_module.c)
 * Context  main for everything in this file
 * Source   ISO 13239 5 and 6 as told in README.md, sources; "our choice:" where those leave one
 *
 * In short: hdlc_nrm_init(), then hdlc_nrm_poll() for ever. The *_ind functions are called from there; all but
 * hdlc_info_ind have defaults in the library.
 */
#ifndef FIELDLING_HDLC_NRM_H
#define FIELDLING_HDLC_NRM_H

#include "hdlc/hdlc_config.h"

enum hdlc_state {
    HDLC_NDM, /* normal disconnected mode: power-up, after DISC, after inactivity */
    HDLC_NRM, /* normal response mode                                             */
    HDLC_FRJ, /* frame reject: a wrong command was received, only SNRM and DISC help */
};

/* Counters wrap at 65536. */
struct hdlc_nrm_counters {
    uint16_t commands;   /* frames to us with good FCS                                 */
    uint16_t responses;
    uint16_t delivered;  /* I-frames given to the application                          */
    uint16_t sequence;   /* I-frames with another N(S) than V(R), duplicates included  */
    uint16_t resent;     /* our I-frames sent again                                    */
    uint16_t rejected;   /* commands answered FRMR                                     */
    uint16_t unanswered; /* frames to us that are no command in this state             */
    uint16_t inactive;   /* times the connection was given up                          */
};
extern struct hdlc_nrm_counters XDATA hdlc_nrm_counters;

/* Power-up: state NDM, chip programmed; mode = HDLC_8273_* (hdlc_8273.h), address 0..254. The source document
 * uses 0..30; address 0 is legal here though HDLC keeps it as no-station address. group = address: none; else
 * UI to that address is carried out and never answered, FFH being all stations. True: the chip answers. */
bool hdlc_nrm_init(uint8_t address, uint8_t group, uint8_t mode);

/* At most one frame is processed and its answer started; the clock of inactivity. Never waits. */
void hdlc_nrm_poll(void);

uint8_t hdlc_nrm_state(void);

/* The application cannot take I-frames for now: they are not accepted and answered RNR. Off after init. */
void hdlc_nrm_busy(bool busy);

/* No frame to us for limit [ms] in NRM or frame reject: NDM. 0: never. HDLC_INACTIVE_MS after init; <= 60000. */
void hdlc_nrm_inactivity(uint16_t limit_ms);

/* ---- implemented by the application --------------------------------------------------------------------- */

/* The information of the next I-frame in sequence, exactly once: info[0..n-1], n <= HDLC_INFO_MAX. Put what is to
 * be answered at answer[0..]; -> its length, at most HDLC_INFO_MAX; 0: no I-frame, RR. info and answer do not
 * overlap. */
uint8_t hdlc_info_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer);

/* Document mode: the same for a frame with control 08H before SNRM, but not protected against duplicates.
 * 0: silence. Default: 0, so that without it the station is strictly standard. */
uint8_t hdlc_document_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer);

/* UI, unnumbered information; not acknowledged. Default: nothing. */
void hdlc_ui_ind(const uint8_t XDATA *info, uint8_t n);

/* XID: the information field of our answer at answer[0..HDLC_XID_MAX-1]; -> its length. Default: 0. */
#define HDLC_XID_MAX 8u
uint8_t hdlc_xid_ind(uint8_t XDATA *answer);

/* The state has changed. Outputs go to their safe state when it becomes HDLC_NDM. Default: nothing. */
void hdlc_state_ind(uint8_t state);

#endif
