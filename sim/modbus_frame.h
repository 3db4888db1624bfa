/* Modbus serial frames by an encoder of its own, CRC and LRC worked out bit by bit and by the book. Knows no
 * time. Source: Modbus over serial line V1.02, 2.5. */
#ifndef SIM_MODBUS_FRAME_H
#define SIM_MODBUS_FRAME_H

#include <stdint.h>

#define MBC_PDU_MAX   253u
#define MBC_FRAME_MAX 600u

enum mbc_mode { MBC_RTU, MBC_ASCII };

struct mbc_coding {
    enum mbc_mode mode;
    uint8_t delimiter; /* ASCII: '\n' */
};

uint16_t mbc_crc(const uint8_t *octets, unsigned n);
uint8_t mbc_lrc(const uint8_t *octets, unsigned n);

/* body = address and PDU, n octets, to a whole frame whose check field is wrong by check_xor. -> octets or
 * characters of the frame */
unsigned mbc_frame(const struct mbc_coding *c, const uint8_t *body, unsigned n, uint16_t check_xor,
                   uint8_t *frame);

/* A whole frame back to address and PDU. -> octets, 0: it is not a good frame */
unsigned mbc_unframe(const struct mbc_coding *c, const uint8_t *frame, unsigned n, uint8_t *body);

#endif
