/* Physical layer over a UART: octets in both directions, idle time, turn-round, and the PHY management services.
 *
 * Layer    hal -> [phy_uart] -> fdl; implements line_octet_isr, line_silence_isr, line_sent_isr
 * Source   EN 50170-2 part 2 (RS-485, 11-bit characters 8E1, part 4, 4.7 for T_SYN, T_SDR); spec A1, A2
 *
 * Receiving by chunks. The layer above says where the next n octets go; it is called when they are all there,
 * not for each one. Between two calls an octet costs a store, an addition and a decrement, whatever the
 * telegram: that is what lets an 8-bit part follow 187.5 kbit/s, and it is the shape of a DMA transfer.
 * It may say, too, how the chunk will begin if it is what it expects; if it is not, the chunk is over sooner. So a
 * telegram like the one before is one chunk, and its receiver is called once, at its end.
 */
#ifndef FIELDLING_PHY_UART_H
#define FIELDLING_PHY_UART_H

#include "check.h"

#define PHY_T_SYN_TBIT 33u /* idle before a request: EN 50170-2 part 4, 4.1.7 */

/* Baud_rate codes: 0..6 as in the source document (A1), the others "our choice: continued". */
enum phy_baud {
    PHY_BAUD_9K6,
    PHY_BAUD_19K2,
    PHY_BAUD_93K75,
    PHY_BAUD_187K5,
    PHY_BAUD_500K,
    PHY_BAUD_38K4, /* not a PROFIBUS rate; kept because the document has it */
    PHY_BAUD_1M5,
    PHY_BAUD_45K45,
    PHY_BAUD_3M,
    PHY_BAUD_6M,
    PHY_BAUD_12M,
    PHY_BAUDS
};

/* PHY variables and what they may be (A2). */
enum phy_variable {
    PHY_TRANSMITTER_OUTPUT, PHY_RECEIVED_SIGNAL_SOURCE, PHY_LOOP,
    PHY_BAUD_RATE, PHY_MEDIUM_RED,
    PHY_VARIABLES
};
enum phy_switch { PHY_DISABLED, PHY_ENABLED };
enum phy_source { PHY_PRIMARY, PHY_ALTERNATE, PHY_RANDOM };
enum phy_medium { PHY_NO_REDUNDANCY, PHY_BUS_A_HIGH, PHY_BUS_B_HIGH };
enum phy_status { PHY_OK, PHY_NO /* this board cannot */, PHY_IV /* no such variable or value */ };

/* ---- management, main --------------------------------------------------------------------------------- */

/* PHY_RESET: transmitter enabled, primary source, no loop, no redundancy, min_T_SDR 11 T_bit; the line is closed
 * (nothing received, nothing sent) until a Baud_rate is set. */
void phy_reset(void);

/* PHY_SET_VALUE -> enum phy_status. Setting Baud_rate or Loop re-opens the line: a telegram on its way is lost. A
 * board has one bus and one receiver: redundancy and the alternate source are answered PHY_NO. With Loop enabled the
 * line is left alone: what phy_answer_isr() sends is what is received. */
uint8_t phy_set_value(uint8_t variable, uint8_t value);

/* PHY_READ_VALUE: the value of variable (< PHY_VARIABLES), 0xFF where there is none. */
uint8_t phy_read_value(uint8_t variable);

/* Wait at least this long [T_bit, 11..255] from the last bit of a request to the first bit of the answer. */
void phy_set_min_t_sdr(uint8_t tbit);
uint8_t phy_min_t_sdr(void);

/* Bit rate [bit/s] and max_T_SDR [T_bit] of a Baud_rate code, 0 for an unknown code. Source of max_T_SDR: EN 50170-2
 * part 8; spec A9. */
uint32_t phy_bit_per_s(uint8_t baud);
uint16_t phy_max_t_sdr(uint8_t baud);

/* PHY_EVENT.indication; implemented by the layer above: a variable changed to value. */
void phy_event_ind(uint8_t variable, uint8_t value);

/* ---- octets, isr ---------------------------------------------------------------------------------------- */

/* Where the receiver is in the chunk. The layer above sets at and left (1..255) to ask for octets, in an upcall.
 * left == 0: deaf, octets are dropped until it asks for more. A port may do an octet's work on this struct itself
 * where line_octet_isr() costs too much, and need not call it at all while the receiver is deaf and no answer waits.
 * When a chunk is complete the receiver is deaf.
 * model: the next octet should be *model; PHY_MODEL_END: it may be any. The layer above sets it for the first chunk after
 * T_SYN; a model is shorter than its chunk. If an octet is another one, less becomes 0 and the chunk `less` octets shorter:
 * it ends with the head of the model, PHY_HEAD octets. If that is the first octet, it has no head: the second octet goes
 * where the first behind the head would have gone, and ends the chunk. If it is behind the head, the chunk ends at once, and
 * left is then not 0: the layer above sets it. After a chunk model is PHY_MODEL_END.
 * Invariant: at[0..left-1] may be written. */
struct phy_rx {
    uint8_t XDATA *at; /* next octet goes here                             */
    uint8_t left;      /* octets missing                                   */
    uint8_t sum;       /* of all octets since it was last cleared, mod 256 */
    uint8_t waiting;   /* an answer waits for T_SDR: an octet cancels it   */
    uint8_t untimed;   /* the line cannot show silence (a pty)             */
    const uint8_t IDATA *model;
    uint8_t less;
};
extern HOT volatile struct phy_rx phy_rx;

/* Models end at the end of phy_model, wherever they begin; written by the layer above while no chunk has one. */
#define PHY_MODEL 9u
#define PHY_HEAD  4u
#define PHY_MODEL_END (phy_model + PHY_MODEL)
extern IDATA uint8_t phy_model[PHY_MODEL];

/* The answer: at[0..len-1], len 1..255. The layer above sets it beforehand, so that nothing is left to be done when
 * the request ends, and changes neither it nor the octets from phy_answer_isr() until phy_done_ind_isr(). */
struct phy_tx {
    const uint8_t XDATA *at;
    uint8_t len;
};
extern HOT struct phy_tx phy_tx;

/* Send phy_tx when min_T_SDR is over. An octet heard before that cancels it: someone else is talking. */
void phy_answer_isr(void) IN_ISR;

/* Implemented by the layer above (fdl_rx). */
void phy_chunk_ind_isr(void) IN_ISR;           /* the octets asked for are there, see struct phy_rx               */
void phy_syn_ind_isr(void) IN_ISR;             /* T_SYN of silence: what comes next is the start of a telegram */
void phy_fault_ind_isr(uint8_t err) IN_ISR;    /* octet with HAL_ERR_*; the receiver is deaf until T_SYN       */
void phy_done_ind_isr(bool sent) IN_ISR;       /* the answer is out, or will not go out: the line was not silent. Does
                                                * not come when main has opened the line anew or reset PHY meanwhile */

#endif
