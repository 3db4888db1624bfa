/* A board for tests of the remote module: what is on its terminals, and what is broken. */
#ifndef REMOTE_BOARD_FAKE_H
#define REMOTE_BOARD_FAKE_H

#include <stdint.h>

struct remote_board_fake {
    uint16_t digital_in, digital_out, analog_in[7], analog_out[6];
    uint16_t stuck_bits, stuck_at;   /* these outputs stay at stuck_at            */
    uint16_t analog_stuck;           /* bit i: output i reads back 0FFF           */
    uint8_t ram[64], ram_stuck_bits; /* bits of octet 7 that read as 0            */
    uint8_t program[200];
    uint16_t program_crc;
    unsigned driven;                 /* calls that set outputs                    */
};
extern struct remote_board_fake board;

void board_fake_begin(void);

#endif
