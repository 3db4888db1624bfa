/* One HDLC line in virtual time: the station under test with its modelled 8273 on one side, a test that speaks
 * for the primary on the other. Bit by bit; nobody driving it, the line is at one.
 */
#ifndef SIM_HDLC_BUS_H
#define SIM_HDLC_BUS_H

#include "hal/posix/hal_8273_model.h"
#include "hal/posix/hal_virtual.h"
#include "sim/hdlc_bits.h"

struct hbus {
    hv_time bit;  /* time; 7200 bit/s after hbus_begin() */
    bool nrzi;    /* the line is NRZI                    */
    bool echo;    /* the station's receiver is on while it sends, too */
    unsigned preframe; /* octets of zeros before each of our frames */

    /* A fault: what the station's receiver (to_station) or ours samples instead of level. NULL: none. */
    bool (*spoil)(bool level, bool to_station);

    /* what the station did */
    uint8_t answer[HB_OCTETS];
    unsigned answer_n;     /* octets of its last good frame, A C I  */
    unsigned answers;      /* good frames since hbus_clear()        */
    unsigned events[HB_LONG + 1]; /* everything else it drove       */
    unsigned collisions;   /* bits both drove                       */
    unsigned stuck;        /* interrupts it left pending            */
    uint64_t driven;       /* bits it drove                         */
    uint64_t turn_round;   /* bits from the end of our frame to its first one */

    /* called for each frame on the line with good FCS. NULL: nobody listens */
    void (*tap)(const uint8_t *octets, unsigned n, bool from_station);

    /* own */
    struct hb_line out;
    unsigned out_at;
    uint64_t now, our_end;
    bool our_level, last_level, answering;
    struct hb_decoder decoder;
};
extern struct hbus hbus;

/* Virtual port and chip as after power-up; line at 7200 bit/s, NRZ. Then set options of the chip. */
void hbus_begin(void);

/* The station: init runs with interrupts masked, loop every bit time from then on. */
void hbus_station(void (*init)(void), void (*loop)(void));

/* Let bit times go by; our bits that wait go out meanwhile. */
void hbus_run(unsigned bits);

/* Send bits as they are / a frame, and wait until they are out. */
void hbus_say_bits(const struct hb_line *line);
void hbus_say(const uint8_t *octets, unsigned n);

/* Send a frame, wait for the answer (at most 1200 bits) and until the line is idle. -> there was exactly one. */
bool hbus_ask(const uint8_t *octets, unsigned n);

void hbus_clear(void);

#endif
