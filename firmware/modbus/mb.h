/* Modbus serial line server ("slave"): what the application sees.
 *
 *     hal  ->  mb_line (RTU), mb_ascii  ->  mb_server: the table of functions  ->  handlers  ->  mb_data
 *              isr: one checked frame        main: mb_poll()                                   your tables
 *
 * Source [A] Modbus application protocol V1.1b3; [S] Modbus over serial line V1.02.
 *
 * In short: describe the functions you want in one header (mb_config.h), your tables in mb_map[], fill in
 * mb_port, call mb_open(), then mb_poll() for ever. Everything named *_ind is called by the server; all but
 * mb_map have defaults in the library, which your function of the same name replaces.
 * Context: main for everything in this file.
 */
#ifndef FIELDLING_MB_H
#define FIELDLING_MB_H

#include "bytes.h"
#include "check.h"
#include "modbus/mb_config.h"

/* ---- the line ------------------------------------------------------------------------------------------ */

enum mb_mode { MB_RTU, MB_ASCII };

/* How the line is. To be filled in before mb_open(); it may be changed and opened again at any time. */
struct mb_port {
    uint32_t bit_per_s; /* 19200 is the standard's default                                                */
    uint8_t format;     /* enum hal_format: HAL_8E1 is the default of RTU, HAL_7E1 that of ASCII          */
    uint8_t mode;       /* enum mb_mode                                                                   */
    uint8_t address;    /* 1..247                                                                         */
    uint16_t gap_tbit;  /* RTU: a silence this long [bit times] ends a frame and there is no t1.5 rule;   */
                        /* 0: t1.5 and t3.5 by the standard                                               */
    uint16_t octet_ms;  /* ASCII: longest time between two characters [ms]; 0: 1000, the standard's       */
};
extern struct mb_port XDATA mb_port;

/* Open the line as mb_port says and listen. -> enum hal_line; HAL_LINE_NO: the board cannot do that rate or
 * format, or address or mode is out of range, or ASCII is not built in: the line is as it was. A request on
 * its way is lost. */
uint8_t mb_open(void);

/* One pass of the server: at most one request is executed and its answer started. Never waits. */
void mb_poll(void);

/* ---- the tables ---------------------------------------------------------------------------------------- */

/* What a block holds. The first four are the function code that reads the table. */
enum mb_table {
    MB_COILS = 1,      /* bits, read and write                                                             */
    MB_INPUTS = 2,     /* bits, read only                                                                  */
    MB_HOLDING = 3,    /* registers, read and write                                                        */
    MB_INPUT_REGS = 4, /* registers, read only                                                            */
    MB_FIFO = 5,       /* first = FIFO pointer address; register 0 = number of values, 1..31 the values    */
    MB_FILE = 6,       /* first = file number, 1..65535; count = records (registers), 0..count-1           */
};

/* Items first..first+count-1 of a table. Registers are uint16_t[count]; bit i is bit i%8 of octet i/8 of
 * uint8_t[(count+7)/8]. data = NULL: the values are where mb_block_ind() says. A request must lie in one
 * block: what is to be read together stands together, and is read in one piece. Blocks must not overlap. */
struct mb_block {
    uint8_t table; /* enum mb_table */
    uint16_t first, count;
    void XDATA *data;
};

/* All blocks of the station, ended by MB_MAP_END. From the application, which may change it between two calls
 * of mb_poll(). */
extern const struct mb_block CODE *mb_map;
#define MB_MAP_END                                                                                           \
    {                                                                                                        \
        0, 0, 0, NULL                                                                                        \
    }

/* The range a request is about, and where its values are (wire order). */
struct mb_span {
    uint8_t table; /* enum mb_table         */
    bool write;
    uint16_t file; /* MB_FILE: its number   */
    uint16_t addr; /* first item            */
    uint16_t qty;  /* items, at least 1     */
    uint8_t XDATA *octets;
};
extern struct mb_span HOT mb_span;

/* Value i of mb_span, 0 <= i < mb_span.qty; a bit is 0 or 1. */
uint16_t mb_span_get(uint16_t i);
void mb_span_put(uint16_t i, uint16_t value);

/* Exception codes [A] 7; 0 is success. */
enum mb_exception {
    MB_OK,
    MB_ILLEGAL_FUNCTION,
    MB_ILLEGAL_ADDRESS,
    MB_ILLEGAL_VALUE,
    MB_DEVICE_FAILURE,
    MB_ACKNOWLEDGE, /* accepted, will take long: the application does it by itself */
    MB_BUSY,
    MB_NEGATIVE_ACKNOWLEDGE, /* [S] counter 6; no longer in [A] */
    MB_MEMORY_PARITY,
};

/* Asked for each range, with functions 20 and 21 twice, after it was found in mb_map and before any item is
 * read or changed. Of a write, mb_span_get() gives the new values. -> MB_OK, or the exception that refuses
 * the whole request. May update what is about to be read. Default: MB_OK. */
uint8_t mb_check_ind(void);

/* The values of mb_span, which lies in a block without data. Read: put them all (the octets hold something
 * else before). Write: take them; it must succeed, mb_check_ind() is where to refuse. -> MB_OK, or the
 * exception of a read. Default: MB_DEVICE_FAILURE. */
uint8_t mb_block_ind(void);

/* A write is done. Default: nothing. */
void mb_written_ind(void);

/* ---- the rest of the device ---------------------------------------------------------------------------- */

/* Function 07: eight status bits. Default: 0. */
uint8_t mb_exception_status_ind(void);

/* Functions 11, 12: is a program command still being processed? Default: no. */
bool mb_busy_ind(void);

/* Function 17: put server id, run indicator (00H off, FFH on) and additional data at octets. -> number of
 * octets, 2..251. Default: 00H FFH. */
uint8_t mb_server_id_ind(uint8_t XDATA *octets);

/* Function 43/14: the objects of the device, by rising id, ended by a row without text. 0 vendor name, 1
 * product code, 2 revision must be there; 3..6 are the regular ones, 128..255 the extended. Text: 0..244
 * characters. Default: vendor "Fieldling", product code and revision "0". */
struct mb_object {
    uint8_t id;
    const char CODE *text;
};
extern const struct mb_object CODE mb_objects[];

/* Function 43/13, CANopen general reference: the request is mb_pdu[0..mb_pdu_len-1], the answer is put there
 * likewise. -> MB_OK or an exception. Default: MB_ILLEGAL_FUNCTION. */
uint8_t mb_canopen_ind(void);

/* Function 8/1 has restarted communication; the answer has left. Default: nothing. */
void mb_restart_ind(void);

/* ---- for handlers of user functions (a row in MB_FUNCTIONS) -------------------------------------------- */

/* A handler is uint8_t handler(void): it finds the request in mb_pdu[0..mb_pdu_len-1] (mb_pdu[0] is the
 * function code), puts the answer there, sets mb_pdu_len (1..253), and returns MB_OK or an exception. */
struct mb_frame {
    uint8_t pdu_len;
    uint8_t adu[MB_ADU_OCTETS]; /* address, PDU, room for CRC or LRC */
};
extern struct mb_frame XDATA mb_frame;
#define mb_adu     (mb_frame.adu)
#define mb_pdu     (mb_frame.adu + 1)
#define mb_pdu_len (mb_frame.pdu_len)

/* Address and quantity of mb_pdu[1..4] to mb_span. -> octets that so many items of table take; 0: the
 * quantity is not 1..regs_max registers or 1..16 * regs_max bits (exception 3, which comes before the address
 * is looked at, [A] 6). regs_max is 1..127. */
uint8_t mb_range(uint8_t table, uint8_t regs_max);

/* The range in mb_span: check() finds its block and asks mb_check_ind(), changing nothing; move() copies the
 * values between mb_span.octets and the block that check() found last; access() does both. -> MB_OK or an
 * exception. */
uint8_t mb_check(void);
uint8_t mb_move(void);
uint8_t mb_access(void);

/* ---- diagnostics, for the application's own display ---------------------------------------------------- */

/* Counters CPT1..CPT8 of [S] appendix A, in the order of function 8's sub-functions 0BH..12H. Wrap at 65536.
 */
enum mb_counter {
    MB_BUS_MESSAGE,
    MB_BUS_ERROR,
    MB_EXCEPTION,
    MB_SLAVE_MESSAGE,
    MB_NO_RESPONSE,
    MB_NAK,
    MB_BUSY_COUNT,
    MB_OVERRUN,
    MB_COUNTERS
};

struct mb_diag {
    uint16_t counter[MB_COUNTERS];
    uint16_t events;     /* function 11: successful messages                                       */
    uint16_t diagnostic; /* function 8/2: the application's; cleared by 8/1 and 8/0AH               */
    bool listen_only;
};
extern struct mb_diag XDATA mb_diag;

#endif
