/* A Modbus server with known contents, and a client on its line to ask it in hexadecimal. Portable like the stack itself:
 * the same tests run on the virtual line, and with modbus_client_fake.c on the targets' simulators. So no large locals here
 * and in the tests: an 8051's stack has some 100 octets. */
#ifndef MODBUS_FIXTURE_H
#define MODBUS_FIXTURE_H

#include "hal/hal.h"
#include "modbus/mb.h"
#include "sim/modbus_client.h"

extern struct mbc client;

/* The tables. Addresses are those of the examples of [A] and of the source document (spec B6). */
extern uint8_t coils_13[5], coils_ac[4], coils_big[250], inputs_c4[3], inputs_big[250];
extern uint16_t holding_0[32], holding_6b[3], holding_big[125], inputs_8[1], input_regs_big[125];
extern uint16_t fifo_4de[32], fifo_bad[32], fifo_short[4], file_3[16], file_4[16], file_9[128],
    file_10[10002];

/* What the application does. */
struct fixture {
    uint8_t veto;      /* mb_check_ind() answers this to writes ...        */
    uint8_t read_veto; /* ... and this to reads                            */
    unsigned checks, writes;
    struct mb_span last;   /* of the last write done                           */
    uint16_t callback[4];  /* holding registers 0200H..0203H, by mb_block_ind  */
    uint8_t callback_bits; /* coils 0300H..0307H likewise                      */
    uint8_t status;        /* function 07                                      */
    bool busy;             /* functions 11, 12                                 */
    unsigned restarts;
    unsigned locks, unlocks;
    void (*slow)(void);    /* called while a write is executed                 */
};
extern struct fixture fx;

/* A fresh station at `address` and 19200 bit/s, contents as above, counters 0, after t3.5 of silence. */
void fixture_begin(uint8_t address, uint8_t mode);

/* Run a test twice: in RTU and in ASCII; setUp() begins in fixture_mode. */
extern uint8_t fixture_mode;
void fixture_both(void (*test)(void), const char *rtu, const char *ascii, int line);
#define BOTH(test) fixture_both(test, #test "_rtu", #test "_ascii", __LINE__)

/* For bodies that are worked out, and for their answers. */
extern uint8_t body[MBC_FRAME_MAX], got[MBC_FRAME_MAX];

/* Send the body (address and PDU, "11 03 00 6B ..."), wait, and compare with the expected body; NULL:
 * silence. */
void ask(const char *request, const char *answer);

/* The same, given as whole RTU frames or ASCII text. */
void ask_raw(const char *request_hex, const char *answer_hex);
void ask_text(const char *request, const char *answer);

/* The same, for the body in body[0..n-1]. */
void ask_body(unsigned n, const char *answer);

/* "01 A2" to octets. -> how many */
unsigned hex_octets(const char *hex, uint8_t *octets);

#endif
