/* Fieldbus data link, responder (passive station): telegrams, FCB, service access points, answers.
 *
 * Layer    phy_uart -> fdl_rx (octets to telegram) -> [fdl] -> ddlm; fdl_tx builds answers; fma manages
 * Context  a telegram is received, checked and answered in interrupt context, from buffers prepared before:
 *          T_SDR never depends on the main loop. Indications for the main loop wait in boxes until fdl_poll().
 * Source   EN 50170-2 part 3 (services), part 4 (protocol); spec A3, A4, D1, D2
 *
 * Buffers change hands by pointer; nothing is copied in an interrupt.
 */
#ifndef FIELDLING_FDL_H
#define FIELDLING_FDL_H

#include "config.h"

/* ---- telegrams (EN 50170-2 part 4, 4.7.1) ------------------------------------------------------------------ */

#define FDL_SD1 0x10u /* 10 DA SA FC FCS 16                       */
#define FDL_SD2 0x68u /* 68 LE LEr 68 DA SA FC [DAE SAE] DU FCS 16 */
#define FDL_SD3 0xA2u /* A2 DA SA FC DU[8] FCS 16                 */
#define FDL_SD4 0xDCu /* DC DA SA, the token                      */
#define FDL_SC  0xE5u /* short acknowledge                        */
#define FDL_ED  0x16u

#define FDL_LE_MIN  4u   /* DA SA FC + one data octet */
#define FDL_LE_MAX  249u /* DA SA FC + 246 data octets */
#define FDL_SD3_DU  8u

#define FDL_ADDRESS_EXT 0x80u /* in DA and SA: a SAP octet follows   */
#define FDL_BROADCAST   127u  /* global address                      */
#define FDL_UNADDRESSED 126u  /* a slave that has no address yet      */
#define FDL_ALL         127u  /* Access: every station               */

/* FC of a request: 0 1 FCB FCV function; of an answer: 0 0 station-type function. */
#define FDL_FC_RESERVED 0x80u
#define FDL_FC_REQUEST  0x40u
#define FDL_FC_FCB      0x20u
#define FDL_FC_FCV      0x10u
#define FDL_FC_FUNCTION 0x0Fu
enum fdl_request {
    FDL_SDA_LOW = 3, FDL_SDN_LOW, FDL_SDA_HIGH, FDL_SDN_HIGH,
    FDL_STATUS = 9,
    FDL_SRD_LOW = 12, FDL_SRD_HIGH, FDL_IDENT, FDL_LSAP_STATUS
};
enum fdl_answer {
    FDL_OK = 0, FDL_UE = 1, FDL_RR = 2, FDL_RS = 3,
    FDL_DL = 8, FDL_NR = 9, FDL_DH = 10, FDL_RDL = 12, FDL_RDH = 13
};

#define FDL_SAP_MAX 62u /* 63 is the global access address, which no slave activates */
#define FDL_SAP_NIL 64u /* our choice: number of the default SAP, the one without address extension */
#define FDL_SAP_NUMBERS 65u

/* Services a SAP may offer; one bit each. SRD covers CSRD: its poll frames are SRD telegrams. */
#define FDL_SDA 0x01u
#define FDL_SDN 0x02u
#define FDL_SRD 0x04u

/* ---- faults and counts --------------------------------------------------------------------------------------- */

/* 16 bits each, wrap; read them with fdl_read_counters(). */
struct fdl_counters {
    uint16_t sd_count;       /* good start delimiters (FMA variable SD_count)                          */
    uint16_t sd_error_count; /* octets that are none where one was due (FMA variable SD_error_count)   */
    uint16_t parity;         /* octet with wrong parity or stop bit                                    */
    uint16_t overrun;        /* octet lost in the receiver                                             */
    uint16_t gap;            /* T_SYN of silence inside a telegram                                     */
    uint16_t format;         /* LE != LEr, LE out of range, no second SD2, no ED, unknown function     */
    uint16_t checksum;       /* FCS                                                                    */
    uint16_t foreign;        /* good telegrams for other stations, tokens, others' answers             */
    uint16_t requests;       /* good requests to this station, broadcast included                      */
    uint16_t retries;        /* of these: repeated by the master, answered again, not executed again   */
    uint16_t answers;        /* given to PHY                                                           */
    uint16_t cancelled;      /* of these: not sent, the line was not silent for T_SDR                  */
    uint16_t refused;        /* answered RS, RR or UE                                                  */
};

/* One more of these. isr. */
void fdl_count_isr(uint16_t XDATA *count) IN_ISR;

/* What has been heard since the caller last cleared it; for time supervision in the main loop. */
#define FDL_HEARD_ANY   0x01u /* an error-free SD1, SD2 or SD3 telegram, from anybody to anybody */
#define FDL_HEARD_OWN   0x02u /* one addressed to this station                                   */
#define FDL_HEARD_OWNER 0x04u /* one addressed to this station by the station set with fdl_watch() */

/* Copies all counters. main. */
void fdl_read_counters(struct fdl_counters XDATA *to);

/* FDL_HEARD_* since the last call. main. */
uint8_t fdl_heard(void);

/* true: telegrams to other stations are received to their end, checked and heard (FDL_HEARD_ANY); so it is after
 * fdl_reset(). false: the receiver stops at their DA, and a fault in the rest of them is not counted. Half of
 * a busy bus is for others: on an 8-bit part that is half of its time. On a line that cannot show silence it has
 * no effect. main. */
void fdl_listen(bool all);

/* Whose telegrams count as FDL_HEARD_OWNER: 0..126, or FDL_ALL for nobody's. main. */
void fdl_watch(uint8_t station);

/* ---- main loop ------------------------------------------------------------------------------------------- */

/* All SAPs deactivated, counters and FCB state cleared, boxes emptied; answers from station address ts (0..126).
 * main. */
void fdl_reset(uint8_t ts);

/* Change of station address TS (0..126), after an answer that is still to be sent. main. */
void fdl_set_address(uint8_t ts);

/* Hand the waiting indications to fdl_data_ind(), oldest first. main. */
void fdl_poll(void);

/* Update_status of an SRD: with what it has been answered. */
enum fdl_update_status { FDL_UPDATED_NO, FDL_UPDATED_LO, FDL_UPDATED_HI };

/* An indication that waits for the main loop: FDL_DATA.indication, FDL_DATA_REPLY.indication. */
struct fdl_ind {
    uint8_t service; /* FDL_SDA, FDL_SDN, FDL_SRD                           */
    bool high;       /* priority of the request                             */
    uint8_t dsap;    /* 0..62, FDL_SAP_NIL                                  */
    uint8_t ssap;    /* 0..63, FDL_SAP_NIL                                  */
    uint8_t sa;      /* station that asked                                  */
    uint8_t update;  /* enum fdl_update_status; NO for SDA and SDN          */
    uint8_t len;     /* of lsdu                                             */
    const uint8_t XDATA *lsdu;
};

/* Implemented by the layer above: one indication of a SAP activated with FDL_TO_MAIN. Valid until return. main. */
void fdl_data_ind(const struct fdl_ind XDATA *ind);

/* ---- service access points ------------------------------------------------------------------------------- */

/* An update buffer: the answer to the next SRD. Three rooms turn: one was sent last (and is kept for the master's
 * retry), one is ready, one is being written by the main loop.
 *
 *   room   | length sum | SD LE LEr SD DA SA FC DAE SAE | L_sdu ......... | FCS ED |
 *
 * A whole frame stands in a room beforehand, up to ED, an SD2. Whether it is the one that answers a request, DA SA FC DAE
 * SAE, is looked at when it is used; else it is built around the data anew.
 * Invariants: sent, ready and spare are the three rooms, in any order; a room with head != 0 holds a frame with a good FCS. */
#define FDL_ROOM_HEAD 11u
#define FDL_ROOM_TAIL 2u
#define FDL_ROOM(lsdu_max) ((lsdu_max) + FDL_ROOM_HEAD + FDL_ROOM_TAIL)

#define FDL_SINGLE 0x01u /* Transmit = single: gone once sent        */
#define FDL_HIGH   0x02u /* answer DH instead of DL                  */
#define FDL_FRESH  0x04u /* ready is newer than sent                 */
#define FDL_HOLD   0x08u /* keep on answering with sent (DP: freeze) */
#define FDL_VALID  0x10u /* there is something to answer with        */

struct fdl_room {
    uint8_t XDATA *octets;
    uint8_t head; /* of its frame, DA..SAE: 3..5 octets; 0: there is no frame */
};
struct fdl_reply {
    uint8_t sap; /* where it is asked as a rule */
    uint8_t is;  /* FDL_FRESH ...               */
    struct fdl_room PAGED *sent;
    struct fdl_room PAGED *ready;
    struct fdl_room PAGED *spare;
    struct fdl_room rooms[3];
    uint8_t max; /* longest L_sdu */
};

/* Bind a reply to three rooms of FDL_ROOM(max) octets laid one after the other at rooms; empty. max 0..246; asked
 * with both SAPs, no more than 244 can be sent: UE. sap, 0..62 or FDL_SAP_NIL: where it will be asked as a rule; its
 * frames are made for that and the SSAP of DP masters, whoever asks otherwise waits longer. main. */
void fdl_reply_init(struct fdl_reply PAGED *reply, uint8_t XDATA *rooms, uint8_t max, uint8_t sap);

/* Who deals with a request once FDL has checked station, service and length (the standard's Indication_mode,
 * widened). */
enum fdl_handling {
    FDL_ANSWER_ONLY, /* nobody: answered from the reply buffer                      */
    FDL_TO_ISR,      /* fdl_ask_isr() decides, fdl_ind_isr() executes               */
    FDL_TO_MAIN,     /* acknowledged now, fdl_data_ind() later; RR when boxes are full */
};

struct fdl_sap {
    uint8_t access;   /* 0..126, or FDL_ALL                            */
    uint8_t services; /* FDL_SDA | FDL_SDN | FDL_SRD, at least one     */
    uint8_t max_len;  /* longest L_sdu of a request; longer: RR        */
    uint8_t handling; /* enum fdl_handling                             */
    struct fdl_reply PAGED *reply; /* or 0: an SRD is answered SC      */
};

/* Activate (or change) / deactivate SAP number 0..62 or FDL_SAP_NIL. False: no such SAP, or FDL_SAPS are active
 * already / it was not active. Use fma.h from outside this folder. main. */
bool fdl_sap_set(uint8_t sap, const struct fdl_sap PAGED *how);
bool fdl_sap_clear(uint8_t sap);

/* The SAP's row; of one that is not active, a row without services. sap < FDL_SAP_NUMBERS. isr, lock. */
struct fdl_sap PAGED *fdl_sap_row_isr(uint8_t sap) IN_ISR;

/* FDL_REPLY_UPDATE.request / .confirm -> enum fdl_l_status. The L_sdu is copied and will answer the next SRD to ssap,
 * with priority FDL_UPDATE_LOW or _HIGH, once (FDL_UPDATE_SINGLE) or until updated again. main. */
enum fdl_l_status {
    FDL_L_OK,
    FDL_L_LS, /* SAP not active or without reply  */
    FDL_L_LR, /* too long for its room            */
    FDL_L_IV
};
#define FDL_UPDATE_LOW    0x00u
#define FDL_UPDATE_HIGH   FDL_HIGH
#define FDL_UPDATE_SINGLE FDL_SINGLE
#define FDL_UPDATE_KEEP   0x04u /* fdl_reply_write() only: leave the priority as it is */
uint8_t fdl_reply_update(uint8_t ssap, const uint8_t XDATA *lsdu, uint8_t len, uint8_t how);

/* The same on a reply that need not be bound to an active SAP yet; len <= reply->max. main. */
void fdl_reply_write(struct fdl_reply PAGED *reply, const uint8_t XDATA *lsdu, uint8_t len, uint8_t how);

/* Make what was written last the next answer even under hold. isr. */
void fdl_reply_release_isr(struct fdl_reply PAGED *reply) IN_ISR;

/* Answer with this priority, FDL_UPDATE_HIGH (DH) or _LOW, from now on. isr, lock. */
void fdl_reply_priority_isr(struct fdl_reply PAGED *reply, uint8_t priority) IN_ISR;

/* There is nothing to answer with until the next update. main. */
void fdl_reply_empty(struct fdl_reply PAGED *reply);

/* ---- the request at hand, isr ---------------------------------------------------------------------------- */

#define FDL_AS_SD3 0x80u

struct fdl_req {
    uint8_t service; /* FDL_SDA, FDL_SDN, FDL_SRD */
    uint8_t dsap;
    uint8_t ssap;
    uint8_t sa;
    uint8_t sd3;     /* FDL_AS_SD3: came as an SD3. our choice: then eight octets go back as an SD3, else as an SD2
                      * as all recorded stations do */
    uint8_t len;     /* of lsdu; the telegram may have been longer: then it was refused */
    uint8_t XDATA *lsdu; /* for fdl_ind_isr() */
    struct fdl_reply PAGED *reply; /* what an SRD will be answered from: the SAP's, or what fdl_ask_isr() puts here */
};
extern HOT struct fdl_req fdl_req;

/* Implemented by the layer above: a request for a SAP activated with FDL_TO_ISR is coming in, its L_sdu is not there
 * yet and it may be wrong: answer, and change nothing. -> FDL_OK: from the reply buffer; FDL_RS, FDL_RR or FDL_UE:
 * refuse. The value is ignored for SDN. May be asked again when main has changed something. isr, lock. */
uint8_t fdl_ask_isr(void) IN_ISR;

/* Implemented by the layer above: the request was good, and has been answered as fdl_ask_isr() said: execute it. Comes
 * once for each request, when its answer is out or will not go out; not if its SAP has been deactivated since. isr. */
void fdl_ind_isr(void) IN_ISR;

/* Indications that the main loop has not dealt with yet wait in boxes: there are none where these two are equal. isr. */
extern volatile HOT uint8_t fdl_box_in;
extern volatile HOT uint8_t fdl_box_out;

/* Is there one for SAP dsap or one of a higher number, from the station of fdl_req? isr. */
bool fdl_waiting_isr(uint8_t dsap) IN_ISR;

/* Keep the L_sdu of fdl_req beyond this interrupt: FDL takes `exchange`, a buffer got from this function before, for
 * the next telegram (0: one from its own stock, which has enough for FDL_KEPT_MAX kept). isr. */
#define FDL_KEPT_MAX 3u
uint8_t XDATA *fdl_keep_isr(uint8_t XDATA *exchange) IN_ISR;

/* Give a kept buffer back for good. main (locks). */
void fdl_give_back(uint8_t XDATA *buffer);

/* Set the answers to the Ident request: four strings behind four length octets (EN 50170-2 part 3, FMA1/2 Ident).
 * main. */
void fdl_set_ident(const uint8_t XDATA *data, uint8_t len);

#endif
