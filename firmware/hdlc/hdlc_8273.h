/* Driver of the Intel 8273: frames in, frames out; flags, zero insertion and FCS are the chip's.
 *
 * Layer    hal_8273 -> [hdlc_8273] -> hdlc_nrm; implements chip_rx_isr, chip_tx_isr
 * Source   register map, commands and results of the 8273: README.md, sources. Where they disagree the driver
 *          depends on neither side; each such place says so.
 * Half duplex: the receiver is off while we send (but in loop-back), so our own frame never comes back as a command.
 * Nothing here waits for the line. Waiting for the chip is bounded by HDLC_8273_POLLS reads of its status;
 * a chip that stays busy longer is set up anew by hdlc_8273_poll() and counted.
 */
#ifndef FIELDLING_HDLC_8273_H
#define FIELDLING_HDLC_8273_H

#include "hdlc/hdlc_config.h"

/* Reads of the status before the chip is taken for dead, and before a result octet is taken for not coming.
 * our choice: some 3 ms and 300 us on a 12 MHz 8051; silicon needs a few clocks. */
#define HDLC_8273_POLLS  250u
#define HDLC_8273_SETTLE 20u

/* How the chip is used; or them together. */
#define HDLC_8273_BUFFERED 0x01u /* address and control octets go through parameters and results        */
#define HDLC_8273_NRZI     0x02u /* needed where the clock is recovered from the line                   */
#define HDLC_8273_PREFRAME 0x04u /* two octets of edges before each frame, for the other side's clock   */
#define HDLC_8273_FLAGS    0x08u /* flags between our frames: only for a line that is ours alone        */
#define HDLC_8273_LOOP     0x10u /* the transmitter feeds the receiver: self-test                       */
#define HDLC_8273_EARLY    0x20u /* interrupt when the last octet was fetched; nothing here needs it     */
#define HDLC_8273_DMA      0x40u /* data by hal_8273_dma_*_isr(), where the port has them                */
#define HDLC_8273_ALL      0x80u /* receive frames to any address (a primary)                           */

struct hdlc_frame {
    uint8_t n; /* octets; more than HDLC_FRAME_MAX: that many or more came, the rest was dropped */
    uint8_t octets[HDLC_FRAME_MAX + 1u]; /* A C I; one more than we take, so that too long shows */
};

/* Indices of the counters: the chip's result codes, then our own. Counters wrap at 65536. */
enum hdlc_8273_rx {
    HDLC_RX_GOOD = 0x00,      /* also code 01, match of the second address                  */
    HDLC_RX_UNKNOWN = 0x02,   /* a code that is in no list                                  */
    HDLC_RX_CRC = 0x03,
    HDLC_RX_ABORT = 0x04,
    HDLC_RX_IDLE = 0x05,      /* normal on RS-485: nobody drives the line between frames     */
    HDLC_RX_EOP = 0x06,
    HDLC_RX_SHORT = 0x07,
    HDLC_RX_OVERRUN = 0x08,   /* we were too slow                                           */
    HDLC_RX_OVERFLOW = 0x09,  /* longer than the DMA buffer                                 */
    HDLC_RX_CARRIER = 0x0A,
    HDLC_RX_RESULTS = 0x0B,   /* a result was not read in time                              */
    HDLC_RX_PARTIAL = 0x0C,   /* good FCS, not a whole number of octets                     */
    HDLC_RX_COUNT = 0x0D,     /* good FCS, but the chip counts other octets than we have    */
    HDLC_RX_FULL = 0x0E,      /* good, but main has not taken the one before                */
    HDLC_RX_COUNTERS
};
enum hdlc_8273_tx {
    HDLC_TX_EARLY,   /* 0C */
    HDLC_TX_GOOD,    /* 0D */
    HDLC_TX_UNDERRUN, /* 0E */
    HDLC_TX_CTS,     /* 0F */
    HDLC_TX_ABORTED, /* 10 */
    HDLC_TX_UNKNOWN,
    HDLC_TX_RESTARTS, /* the chip was set up anew: dead, or a frame did not get out */
    HDLC_TX_COUNTERS
};
struct hdlc_8273_counters {
    uint16_t rx[HDLC_RX_COUNTERS];
    uint16_t tx[HDLC_TX_COUNTERS];
};
extern volatile struct hdlc_8273_counters XDATA hdlc_8273_counters;

/* Reset and program the chip: mode = HDLC_8273_* or'ed; frames to a1 or a2 are received (a2 = a1: only one
 * address). Forgets all frames, clears the counters. True: the chip answers. False: it does not, and
 * hdlc_8273_poll() goes on trying. main. */
bool hdlc_8273_open(uint8_t mode, uint8_t a1, uint8_t a2);

/* Supervise the chip. Each pass of the main loop. */
void hdlc_8273_poll(void);

/* The oldest frame received, FCS good, or NULL. It stays, and is the same, until hdlc_8273_release(). main. */
const struct hdlc_frame XDATA *hdlc_8273_frame(void);
void hdlc_8273_release(void);

/* Send the frame that is in hdlc_8273_out.octets[0..n-1], 2 <= n <= HDLC_FRAME_MAX; hdlc_8273_out is the driver's
 * while hdlc_8273_sending(). Not while sending. main. */
extern struct hdlc_frame XDATA hdlc_8273_out;
void hdlc_8273_send(uint8_t n);
bool hdlc_8273_sending(void);

/* Give up the frame being sent: an abort goes out. main. */
void hdlc_8273_abort(void);

/* Carry out a command with one mask, or with none and an immediate result: set bits (OR), reset bits (AND the
 * mask) of a mode register or of port B; read a port. The level that means "active" in a port differs between the
 * sources: try it on the board. -> false / -1: the chip does not answer. main. */
enum hdlc_8273_mask {
    HDLC_8273_SET_DELAY = 0xA4,
    HDLC_8273_RESET_DELAY = 0x64,
    HDLC_8273_SET_TRANSFER = 0x97,
    HDLC_8273_RESET_TRANSFER = 0x57,
    HDLC_8273_SET_OPERATING = 0x91,
    HDLC_8273_RESET_OPERATING = 0x51,
    HDLC_8273_SET_SERIAL = 0xA0,
    HDLC_8273_RESET_SERIAL = 0x60,
    HDLC_8273_SET_PORT_B = 0xA3,
    HDLC_8273_RESET_PORT_B = 0x63,
};
enum hdlc_8273_port { HDLC_8273_PORT_A = 0x22, HDLC_8273_PORT_B = 0x23 };
bool hdlc_8273_mask(uint8_t command, uint8_t mask);
int16_t hdlc_8273_port(uint8_t command);

#endif
