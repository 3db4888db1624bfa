/* What the files of this folder share. */
#ifndef FIELDLING_FDL_PRIV_H
#define FIELDLING_FDL_PRIV_H

#include "fdl/fdl.h"

/* A telegram buffer: SD LE LEr SD | DA SA FC ... FCS ED. The body starts at a fixed place for every format. */
#define FDL_BODY    4u
#define FDL_BUF_LEN (FDL_BODY + FDL_BODY_MAX + 2u)

extern struct fdl_counters XDATA fdl_counters;

/* ---- fdl_rx: octets to telegram ---- */

extern uint8_t XDATA *HOT fdl_rx_buf; /* telegram being received; replaced only from fdl_telegram_isr() */

/* The telegram being received. In internal RAM, and handed on by name: SDCC keeps arguments and pointers that do not
 * fit its registers in external RAM, at four times the price. */
struct fdl_header {
    uint8_t len;     /* DA..last DU octet, 3..249                                                       */
    uint8_t da;
    uint8_t sa;
    uint8_t fc;
    uint8_t more[2]; /* the octets behind these (of a body of three or four: FCS and ED); set by fdl.c  */
    uint8_t fcs;     /* at its end                                                                      */
    uint8_t sd3;     /* 1: it is an SD3                                                                 */
    uint8_t whole;   /* 0: longer than FDL_BODY_MAX, only DA SA FC and more[] are to be trusted         */
};
extern HOT struct fdl_header fdl_header;

/* One more of these. */
void fdl_count_isr(uint16_t XDATA *count) IN_ISR;

/* Forget what was being received. main with interrupts masked. */
void fdl_rx_reset(void);

/* Implemented by fdl.c: len, DA SA FC have been received, FCS not yet checked: nothing may be done that lasts.
 * True: go on; false: nobody here wants the rest, hear nothing until the next T_SYN. */
bool fdl_header_isr(void) IN_ISR;

/* Implemented by fdl.c: the two octets behind the header are there, too. FCS not yet checked. */
void fdl_saps_isr(void) IN_ISR;

/* Implemented by fdl.c: fdl_rx_buf holds a telegram with good FCS and ED, its body from fdl_rx_buf[FDL_BODY] on. */
void fdl_telegram_isr(void) IN_ISR;

/* Implemented by fdl.c: a token or a short acknowledge went by. */
void fdl_other_isr(void) IN_ISR;

/* ---- fdl_tx: answers ---- */

struct fdl_frame {
    const uint8_t XDATA *at;
    uint8_t len;
    uint8_t function;
};
extern IDATA struct fdl_frame fdl_tx; /* the answer built last */

/* Build an answer to fdl_req from station ts into fdl_tx. */
void fdl_tx_short_isr(void) IN_ISR;                           /* SC                                        */
void fdl_tx_fixed_isr(uint8_t function) IN_ISR;               /* SD1                                       */
void fdl_tx_status_isr(uint8_t function) IN_ISR;              /* SD1 that leaves the kept answer alone      */
void fdl_tx_reply_isr(struct fdl_reply PAGED *reply) IN_ISR;  /* SD2, SD3, SD1 or SC, as the reply has it  */

/* ---- fdl_sap: service access points ---- */

void fdl_sap_reset(void);

/* Update buffers that answer Ident, and LSAP status of SAP fdl_req.dsap (0: not active). */
struct fdl_reply PAGED *fdl_ident_reply_isr(void) IN_ISR;
struct fdl_reply PAGED *fdl_lsap_reply_isr(void) IN_ISR;

/* ---- fma_watch: supervision of the bus, main ---- */

void fma_watch_reset(void);
void fma_watch_t_sl(uint16_t t_sl);                     /* slot time or rate has changed              */
void fma_watch_cleared(const uint16_t XDATA *count);    /* sd_count or sd_error_count has been cleared */
uint16_t fma_count(const uint16_t XDATA *count);        /* of fma.c: the count, read with interrupts masked */

extern HOT uint8_t fdl_ts; /* this station's address */

#endif
