/* What the files of this folder share. */
#ifndef FIELDLING_FDL_PRIV_H
#define FIELDLING_FDL_PRIV_H

#include "fdl/fdl.h"

/* A telegram buffer: SD LE LEr SD | DA SA FC ... FCS ED. The body starts at a fixed place for every format. */
#define FDL_BODY    4u
#define FDL_BUF_LEN (FDL_BODY + FDL_BODY_MAX + 2u)

extern struct fdl_counters XDATA fdl_counters;

/* ---- fdl_rx: octets to telegram ---- */

extern uint8_t XDATA *HOT fdl_rx_buf; /* telegram being received; replaced only while the receiver is deaf */

/* The telegram being received. In internal RAM, and handed on by name: SDCC keeps arguments and pointers that do not
 * fit its registers in external RAM, at four times the price. */
struct fdl_header {
    uint8_t len;     /* DA..last DU octet, 3..249                                                       */
    uint8_t da;
    uint8_t sa;
    uint8_t fc;
    uint8_t more[2]; /* the octets behind these, where one of them is a SAP                             */
    uint8_t fcs;     /* at its end                                                                      */
};
extern HOT struct fdl_header fdl_header;

/* Forget what was being received. main with interrupts masked. */
void fdl_rx_reset(void);

/* Implemented by fdl_plan.c: DA has been received, for us or for all, and len is known. FCS not yet checked: nothing may
 * be done that lasts, here or in the next two. */
void fdl_da_isr(uint8_t da) IN_ISR;

/* Implemented by fdl_plan.c: so have SA and FC. -> The (up to) two octets behind them are SAPs: tell when they are there. */
bool fdl_header_isr(void) IN_ISR;

/* Implemented by fdl_plan.c: these are there. */
void fdl_saps_isr(void) IN_ISR;

/* Implemented by fdl_plan.c: T_SYN is over. -> One telegram is awaited: it is planned, fdl_header says which one, and the
 * last fdl_plan.awaited octets of phy_model how it begins. */
bool fdl_await_isr(void) IN_ISR;

/* Implemented by fdl.c: fdl_rx_buf holds a telegram with good FCS and ED, its body from fdl_rx_buf[FDL_BODY] on. */
void fdl_telegram_isr(void) IN_ISR;

/* Implemented by fdl.c: T_SYN of silence: a request that still waits to be executed will not be. */
void fdl_drop_isr(void) IN_ISR;

/* Implemented by fdl.c: a token or a short acknowledge went by. */
void fdl_other_isr(void) IN_ISR;

/* ---- fdl_tx: answers ---- */

/* Build an answer to fdl_header and fdl_req into phy_tx. None of them touches the answer that is kept for a retry. */
void fdl_tx_short_isr(void) IN_ISR;                /* SC                                                        */
void fdl_tx_fixed_isr(uint8_t function) IN_ISR;    /* SD1                                                       */
void fdl_tx_status_isr(void) IN_ISR;               /* SD1: OK                                                   */
void fdl_tx_keep_isr(void) IN_ISR;                 /* the SD1 built last is kept: the next one goes elsewhere   */

/* The same in a room: build the frame around its L_sdu, which fits; phy_tx says already where it goes. */
void fdl_tx_frame_isr(struct fdl_room PAGED *room) IN_ISR;

/* ---- fdl_sap: service access points ---- */

void fdl_sap_reset(void);

/* SAP number -> its row; of all that are not active, a row without services. */
extern struct fdl_sap PAGED *XDATA fdl_row_of[FDL_SAP_NUMBERS];

/* Update buffer that answers Ident. */
struct fdl_reply PAGED *fdl_ident_reply_isr(void) IN_ISR;

/* LSAP status of SAP fdl_req.dsap -> FDL_OK, or FDL_RS: it is not active. Then the frame around it, into phy_tx. */
uint8_t fdl_lsap_isr(void) IN_ISR;
void fdl_tx_lsap_isr(void) IN_ISR;

/* ---- fma_watch: supervision of the bus, main ---- */

void fma_watch_reset(void);
void fma_watch_t_sl(uint16_t t_sl);                     /* slot time or rate has changed              */
void fma_watch_cleared(const uint16_t XDATA *count);    /* sd_count or sd_error_count has been cleared */
uint16_t fma_count(const uint16_t XDATA *count);        /* of fma.c: the count, read with interrupts masked */

extern HOT uint8_t fdl_ts; /* this station's address */

/* ---- fdl_plan: what is done when the telegram turns out to be good ----
 *
 * Made from the header and the SAPs while the rest comes in. Nothing that lasts is done before the end, and main makes
 * the plan anew where it changes what a plan was made from: at the end there is nothing left to decide. */
enum fdl_stage {
    FDL_IDLE,
    FDL_AWAITED, /* the request that will come next is planned                        */
    FDL_OTHERS,  /* what is coming in is not for us                                   */
    FDL_UNKNOWN, /* it is for us, and no request that a responder knows               */
    FDL_PLANNED, /* a request to us is coming in                                      */
    FDL_TO_BOOK  /* it was good, its answer is on its way: executed when that is out  */
};

/* Value of fdl_req.service beside FDL_SDA, FDL_SDN, FDL_SRD. */
#define FDL_NUMBERLESS 0x20u /* FDL status, Ident, LSAP status: they leave the FCB alone */

/* FC function -> service, and whether it is the one of high priority. */
#define FDL_IS_HIGH 0x80u
extern const CODE uint8_t fdl_functions[FDL_FC_FUNCTION + 1u];

struct fdl_plan {
    uint8_t stage;
    uint8_t hears;    /* FDL_HEARD_*                                                     */
    uint8_t refusal;  /* FDL_OK: none                                                    */
    uint8_t handling; /* who executes the request: FDL_ANSWER_ONLY: nobody                */
    uint8_t is;       /* of fdl_req.reply, FDL_FRESH only where it is to be turned        */
    uint8_t late;     /* the frame of fdl_req.reply is to be built when the telegram is good */
    uint8_t stale;    /* fdl_req.reply has been written since: fdl_refresh_isr() before phy_tx is used    */
    uint8_t turn;     /* what is being sent is `ready` of fdl_req.reply: to be turned                    */
    uint8_t again;    /* FC is that of the request answered last: perhaps a retry         */

    /* What follows from header and SAPs alone stays as it is while the same ones come again and main changes nothing:
     * in cyclic traffic nearly always. */
    uint8_t made;     /* for a header with this length; 0: not at all */
    uint8_t awaited;  /* octets of the model of the telegram that is planned and may come next; 0: none is */
    uint8_t same;     /* the header is the same, its SAPs are to come */
    uint8_t result;   /* FDL_OK, or what the SAP's row refuses with    */
    uint8_t row_handling;
    struct fdl_reply PAGED *row_reply;
};
extern HOT struct fdl_plan fdl_plan;

/* The last numbered request and its answer. A frame is a retry only if it is the same frame: FCV, same SA, same
 * FCB and octet-identical, for which length, header, the two octets behind it (SAPs) and FCS are compared. Masters
 * that forget to restart the FCB after a lost answer would otherwise be answered with stale data for ever (facts,
 * section 0). */
struct fdl_last {
    uint8_t len; /* 0: none */
    uint8_t da;
    uint8_t sa;
    uint8_t fc;
    uint8_t more[2];
    uint8_t fcs;
    const uint8_t XDATA *answer;
    uint8_t answer_len;            /* 0: its room has been given up: answer with what there is now */
    struct fdl_reply PAGED *reply; /* the answer stands in its room; 0 = elsewhere */
};
extern IDATA struct fdl_last fdl_last;

extern IDATA uint8_t fdl_watched;
extern IDATA uint8_t fdl_skips_others; /* telegrams of others are of no interest */

bool fdl_box_is_free_isr(void) IN_ISR;

/* main, locked: SAP, reply or address have changed (reply: only this one; 0: anything). */
void fdl_replan_isr(struct fdl_reply PAGED *reply) IN_ISR;

/* The same for a reply in two parts, so that the lock is short: it has been written; then a plan that is made from it is
 * made anew, unless the request has come to its end meanwhile and done that. main, locked. */
void fdl_written_isr(struct fdl_reply PAGED *reply) IN_ISR;
void fdl_refresh_isr(void) IN_ISR; /* and isr */

/* main, locked: fdl_ask_isr() or a box may say another thing now. */
void fdl_resettle_isr(void) IN_ISR;

/* main, locked: no plan of a telegram to come is right any more. */
void fdl_unplan_isr(void) IN_ISR;

/* The answer is out: the next request has another FCB. */
void fdl_answered_isr(void) IN_ISR;

/* Take `ready` for `sent`. */
void fdl_turn_isr(struct fdl_reply PAGED *reply) IN_ISR;

/* The same for what is being sent, if that has not been done yet. isr, lock. */
void fdl_turn_sent_isr(void) IN_ISR;

#endif
