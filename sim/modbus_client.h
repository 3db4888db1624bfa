/* A Modbus serial client ("master") with its own encoder, RTU and ASCII, that can also be wrong on purpose.
 *
 * The encoder half (mbc_frame, mbc_unframe) knows no time. The line half talks to the station on the virtual port
 * (hal_virtual.h). Source: Modbus over serial line V1.02, 2.5.
 */
#ifndef SIM_MODBUS_CLIENT_H
#define SIM_MODBUS_CLIENT_H

#include "hal_virtual.h"

#define MBC_PDU_MAX   253u
#define MBC_FRAME_MAX 600u

enum mbc_mode { MBC_RTU, MBC_ASCII };

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
    enum mbc_mode mode;
    uint8_t delimiter; /* ASCII: '\n' */
    struct mbc_wrong wrong;
    hv_time time_out; /* for an answer */
    /* what was heard: */
    uint8_t heard[MBC_FRAME_MAX];
    unsigned heard_n;
    hv_time request_end, answer_start, answer_end;
};

/* CRC-16 and LRC, bit by bit and by the book. */
uint16_t mbc_crc(const uint8_t *octets, unsigned n);
uint8_t mbc_lrc(const uint8_t *octets, unsigned n);

/* body = address and PDU, n octets, to a whole frame. -> octets or characters of the frame */
unsigned mbc_frame(const struct mbc *c, const uint8_t *body, unsigned n, uint8_t *frame);

/* A whole frame back to address and PDU. -> octets, 0: it is not a good frame */
unsigned mbc_unframe(const struct mbc *c, const uint8_t *frame, unsigned n, uint8_t *body);

/* The client takes the line of the virtual port; mode RTU, nothing wrong, time-out 1 s. Once, after hv_begin(). */
void mbc_begin(struct mbc *c);

/* Put octets on the line from now on, back to back, with what is wrong. Time goes on to the end of the last one. */
void mbc_put(struct mbc *c, const uint8_t *octets, unsigned n);

/* Send body as a frame after t_before of silence. */
void mbc_send(struct mbc *c, const uint8_t *body, unsigned n);

/* Wait for an answer until time_out. -> octets of its body, 0: none, or not a good frame (then heard_n is not 0). */
unsigned mbc_wait(struct mbc *c, uint8_t *body);

/* Silence for so many bit times. */
void mbc_idle(unsigned tbit);

#endif
