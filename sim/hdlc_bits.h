/* HDLC on the wire, bit by bit: flags, zero insertion, FCS; encoder and decoder of the simulation's own.
 *
 * Source: ISO 13239 4 (frame structure) as in facts 2.5; octets go out least significant bit first. A bit is
 * one uint8_t, 0 or 1, before NRZI.
 */
#ifndef SIM_HDLC_BITS_H
#define SIM_HDLC_BITS_H

#include <stdbool.h>
#include <stdint.h>

#define HB_OCTETS 300u  /* of a frame, A C I */
#define HB_BITS   3200u /* of a frame with FCS, flags and every possible inserted zero */

struct hb_line {
    unsigned n;
    unsigned inserted; /* zeros inserted so far */
    unsigned ones;     /* run at the end, for the zero insertion */
    uint8_t bit[HB_BITS];
};

/* CRC-16/X-25 as it is sent, low octet first: polynomial 1021H, start FFFFH, complemented. */
uint16_t hb_fcs(const uint8_t *octets, unsigned n);

/* The CRC register after one more bit; start 0xFFFF; over a good frame with its FCS it ends as HB_RESIDUE. */
uint16_t hb_crc_bit(uint16_t crc, unsigned bit);
#define HB_RESIDUE 0xF0B8u

/* Append to the line: bits as they are; a flag; octets with zero insertion; flag, octets, FCS, flag. */
void hb_raw(struct hb_line *line, uint32_t bits, unsigned n);
void hb_flag(struct hb_line *line);
void hb_stuffed(struct hb_line *line, const uint8_t *octets, unsigned n);
void hb_frame(struct hb_line *line, const uint8_t *octets, unsigned n);

enum hb_event {
    HB_NOTHING,
    HB_FRAME,     /* octets[0..n-1], good FCS, FCS not counted            */
    HB_BAD_FCS,   /* the same with a wrong FCS                           */
    HB_SHORT,     /* less than 32 bits between two flags                 */
    HB_UNALIGNED, /* not a whole number of octets                        */
    HB_ABORT,     /* seven ones inside a frame                           */
    HB_IDLE,      /* fifteen ones                                        */
    HB_LONG,      /* more than HB_OCTETS: skipped up to the next flag    */
};

/* Start with {0}: waiting for a flag. */
struct hb_decoder {
    bool in_frame;
    unsigned ones, bits, n;
    uint8_t octets[HB_OCTETS + 8u];
};

enum hb_event hb_decode(struct hb_decoder *d, unsigned bit);

#endif
