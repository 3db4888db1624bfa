/* A Modbus serial client ("master") on a station's line, RTU and ASCII, that can also be wrong on purpose.
 *
 * Two lines implement it: modbus_client.c the virtual port's, exact to a fraction of a bit; and that of a machine without
 * time, host_tests/modbus_client_fake.c, in whole bit times and without 64-bit arithmetic, for the targets' simulators.
 */
#ifndef SIM_MODBUS_CLIENT_H
#define SIM_MODBUS_CLIENT_H

#include "sim/modbus_frame.h"

/* What is wrong with the next frames; all 0: nothing. Positions count octets in RTU, characters in ASCII. */
struct mbc_wrong {
    uint16_t check_xor; /* on CRC or LRC                                                                */
    unsigned cut;       /* that many octets are missing at the end                                      */
    unsigned
        extra; /* that many octets 55 (ASCII: '0') come behind the end. (Not 00: a CRC does not see it) */
    unsigned gap_at;      /* before octet number gap_at (1..) ...                                         */
    uint32_t gap;         /* ... the line is silent for so long [T_bit]                                   */
    unsigned err_at;      /* octet number err_at (0..) arrives ...                                        */
    uint8_t err;          /* ... with these HAL_ERR_ flags                                                */
    const uint8_t *noise; /* heard before the frame ...                                                   */
    unsigned noise_n;
    uint32_t noise_gap; /* ... and so long after it the frame starts [T_bit]; 0: at once                */
};

struct mbc {
    struct mbc_coding coding;
    struct mbc_wrong wrong;
    uint32_t time_out; /* for the start of an answer [ms] */
    /* what was heard: */
    uint8_t heard[MBC_FRAME_MAX];
    unsigned heard_n;
    uint32_t answer_delay; /* from the end of the request to the start of the answer [T_bit], rounded down */
    uint32_t answer_time;  /* from its start to its end [T_bit] */
};

/* A machine as delivered, and the client takes its line; mode RTU, nothing wrong, time-out 1 s. At the start of a test. */
void mbc_begin(struct mbc *c);

/* The machine has power (again; its NV memory stays): from now on loop is its background loop, interrupts are on. */
void mbc_power_on(void (*loop)(void));

/* The station has used its port by the rules, or the test fails. At the end of a test. */
void mbc_end(void);

/* isr, of the application, comes whenever an interrupt can, from now to the end of the test. */
void mbc_interrupt(void (*isr)(void));

/* Put octets on the line from now on, back to back, with what is wrong. Time goes on to the end of the last
 * one. */
void mbc_put(struct mbc *c, const uint8_t *octets, unsigned n);

/* Send body as a frame. */
void mbc_send(struct mbc *c, const uint8_t *body, unsigned n);

/* Wait up to time_out for an answer to start, and for its end. -> octets of its body, 0: none, or not a good
 * frame (then heard_n is not 0). */
unsigned mbc_wait(struct mbc *c, uint8_t *body);

/* Silence for so many bit times / milliseconds. */
void mbc_idle(uint32_t tbit);
void mbc_idle_ms(uint32_t ms);

/* As the station has the line open: bit times in so many milliseconds, rounded down; enum hal_format. */
uint32_t mbc_tbit_of_ms(uint32_t ms);
uint8_t mbc_format(void);

#endif
