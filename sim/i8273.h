/* Intel 8273 SDLC/HDLC protocol controller, register level and bit level. Written from the facts (1.1-1.10)
 * alone; where sources disagree the difference is an option below, so that drivers can be tested against both.
 *
 *     processor side   i8273_read, i8273_write, int_tx/int_rx, drq_tx/drq_rx
 *     line side        once per bit time: i8273_shift_out, then i8273_shift_in with the level on the line
 */
#ifndef SIM_I8273_H
#define SIM_I8273_H

#include <stdbool.h>
#include <stdint.h>

/* Addresses A1 A0 (facts 1.2); the data registers are selected by /TxDACK and /RxDACK. */
enum i8273_register {
    I8273_COMMAND = 0,   /* read: status            */
    I8273_PARAMETER = 1, /* read: immediate result  */
    I8273_RESET = 2,     /* read: TxI/R             */
    I8273_RX_RESULT = 3, /* read only: RxI/R        */
    I8273_TX_DATA = 4,
    I8273_RX_DATA = 8,
};

enum i8273_status {
    I8273_CBSY = 0x80,
    I8273_CBF = 0x40,
    I8273_CPBF = 0x20,
    I8273_CRBF = 0x10,
    I8273_RXINT = 0x08,
    I8273_TXINT = 0x04,
    I8273_RXIRA = 0x02,
    I8273_TXIRA = 0x01,
};

/* Mode bits (facts 1.5). */
enum { OP_FLAGS = 0x01, OP_PREFRAME = 0x02, OP_BUFFERED = 0x04, OP_EARLY = 0x08, OP_EOP = 0x10, OP_HDLC = 0x20 };
enum { IO_NRZI = 0x01, IO_CLOCK_LOOP = 0x02, IO_DATA_LOOP = 0x04 };

/* Where the sources disagree. All zero is RBIL and the hardware re-creation; HAPN's side is 1. */
struct i8273_options {
    bool reset_at_1;         /* the reset register is written at offset 1, not 2                          */
    bool one_error_result;   /* an error gives one result octet, not 3 or 5                               */
    bool abort_disables;     /* the receiver is disabled after result 04                                  */
    bool plain_partial;      /* the partial octet code is n-1, not its bits reversed                      */
    bool ports_inverted;     /* port A reads 1 = active, not the pin's level; port B drives likewise      */
    bool short_when_buffered; /* result 07 in buffered mode, too                                          */
    uint8_t hold_reads;      /* CBSY and CPBF stay for so many reads of the status after a write          */
    uint8_t result_reads;    /* xIRA is 0 for so many reads of the status between two octets of a result  */
};

struct i8273_results {
    uint8_t octet[5], n, at, wait;
};

/* What the transmitter does when the octet it is sending is out. */
enum i8273_tx {
    TX_IDLE,
    TX_CTS,      /* waits for clear to send                    */
    TX_EOP,      /* waits for the go-ahead of a loop           */
    TX_PREFRAME, /* sends a synchronising octet                */
    TX_OPEN,     /* sends the opening flag                     */
    TX_DATA,     /* sends an octet, or the FCS after the last   */
    TX_CLOSE,    /* sends the closing flag                     */
    TX_END,      /* reports the end of the frame               */
    TX_ABORT,    /* reports the end of an abort                */
    TX_FLAGS,    /* sends flags between frames                 */
};

struct i8273 {
    struct i8273_options option; /* set after i8273_power_on() */
    bool cts, cd;                /* pins, true = active; power-on: active           */
    uint8_t pa;                  /* PA4..PA2 in bits 4..2, levels                    */

    uint8_t operating, serial_io, transfer, delay, port_b;

    /* the line's side: read these after i8273_shift_out() */
    bool txd; /* level   */
    bool rts; /* the driver is on */

    /* how the processor misused the chip: a test looks at this */
    unsigned lost_commands, lost_parameters, data_without_request;

    /* own, command phase */
    uint8_t command, need, given, parameter[4], result;
    bool in_command, result_full;
    uint8_t busy_reads, parameter_reads;

    struct i8273_tx_side {
        enum i8273_tx state;
        uint8_t command; /* C8, C9, CA */
        uint16_t left;   /* octets still to be asked for */
        uint8_t head[2], heads; /* buffered: A and C, to be sent first */
        bool request, full, early_done;
        uint8_t holding, abort_result;
        bool auto_rts;
        uint16_t shift, fcs;
        uint8_t bits; /* left in shift */
        uint8_t ones, preframes;
        bool stuff, level;
        struct i8273_results results;
    } tx;

    struct i8273_rx_side {
        bool enabled, in_frame, selected, activity;
        uint8_t command;
        uint16_t limit, count;
        uint8_t a1, a2, match;
        bool level, delayed; /* last level, for NRZI and the one-bit delay */
        uint8_t ones;
        uint32_t bits; /* of the frame, the five ones and the zero of the closing flag included */
        uint64_t window; /* the newest bit is the top one */
        uint16_t crc;
        uint8_t a, c;
        uint8_t data;
        bool full;
        struct i8273_results results;
    } rx;
};

/* As after RESET: modes 0, receiver off, port B 3FH; options all zero, CTS and CD active. */
void i8273_power_on(struct i8273 *chip);

uint8_t i8273_read(struct i8273 *chip, uint8_t reg);
void i8273_write(struct i8273 *chip, uint8_t reg, uint8_t value);

bool i8273_int_tx(const struct i8273 *chip);
bool i8273_int_rx(const struct i8273 *chip);
bool i8273_drq_tx(const struct i8273 *chip);
bool i8273_drq_rx(const struct i8273 *chip);

/* Falling edge of /TxC: the next bit goes out (txd, rts). Rising edge of /RxC: the line is sampled. */
void i8273_shift_out(struct i8273 *chip);
void i8273_shift_in(struct i8273 *chip, bool level);

/* Between i8273.c and i8273_line.c. */
void i8273_transmit(struct i8273 *chip);
void i8273_abort(struct i8273 *chip);
void i8273_tx_result(struct i8273 *chip, uint8_t code);

#endif
