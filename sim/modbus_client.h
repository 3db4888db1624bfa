/* A Modbus serial client ("master") on the virtual port's line, RTU and ASCII, that can also be wrong on
 * purpose. */
#ifndef SIM_MODBUS_CLIENT_H
#define SIM_MODBUS_CLIENT_H

#include "hal_virtual.h"
#include "sim/modbus_frame.h"

/* What is wrong with the next frames; all 0: nothing. Positions count octets in RTU, characters in ASCII. */
struct mbc_wrong {
    uint16_t check_xor; /* on CRC or LRC                                                                */
    unsigned cut;       /* that many octets are missing at the end                                      */
    unsigned
        extra; /* that many octets 55 (ASCII: '0') come behind the end. (Not 00: a CRC does not see it) */
    unsigned gap_at;      /* before octet number gap_at (1..) ...                                         */
    hv_time gap;          /* ... the line is silent for so long                                           */
    unsigned err_at;      /* octet number err_at (0..) arrives ...                                        */
    uint8_t err;          /* ... with these HAL_ERR_ flags                                                */
    const uint8_t *noise; /* heard before the frame ...                                                   */
    unsigned noise_n;
    hv_time noise_gap; /* ... and so long after it the frame starts; 0: at once                        */
};

struct mbc {
    struct mbc_coding coding;
    struct mbc_wrong wrong;
    hv_time time_out; /* for the start of an answer */
    /* what was heard: */
    uint8_t heard[MBC_FRAME_MAX];
    unsigned heard_n;
    hv_time request_end, answer_start, answer_end;
};

/* The client takes the line of the virtual port; mode RTU, nothing wrong, time-out 1 s. Once, after
 * hv_begin(). */
void mbc_begin(struct mbc *c);

/* Put octets on the line from now on, back to back, with what is wrong. Time goes on to the end of the last
 * one. */
void mbc_put(struct mbc *c, const uint8_t *octets, unsigned n);

/* Send body as a frame after t_before of silence. */
void mbc_send(struct mbc *c, const uint8_t *body, unsigned n);

/* Wait up to time_out for an answer to start, and for its end. -> octets of its body, 0: none, or not a good
 * frame (then heard_n is not 0). */
unsigned mbc_wait(struct mbc *c, uint8_t *body);

/* Silence for so many bit times. */
void mbc_idle(unsigned tbit);

#endif
