/* An RS-485 segment in virtual time: carries octets between the station under test and any number of parties,
 * and judges every one of them against the rules of the line.
 *
 * The station under test is the one behind the virtual port (hal_virtual.h). Parties are the test's: a
 * master, scripted stations, noise. Two that drive the line at once spoil each other's octets.
 *
 * Source of the rules: EN 50170-2 part 4, 4.1.7 (T_SYN), 4.1.6 (T_SDR), 4.7 (no idle inside a telegram);
 * max_T_SDR by rate: part 8, spec A9. Verdicts of parties with `judged` unset are not taken.
 */
#ifndef SIM_SEGMENT_H
#define SIM_SEGMENT_H

#include "hal_virtual.h"
#include "sim/telegram.h"
#include "sim/uart.h"

enum seg_rule {
    SEG_COLLISION, /* started to drive while another one did             */
    SEG_EARLY,     /* answer earlier than min_T_SDR                      */
    SEG_LATE,      /* answer later than max_T_SDR                        */
    SEG_NO_SYN,    /* request after less than 33 T_bit of idle line      */
    SEG_GAP,       /* idle inside a telegram                             */
    SEG_DRIVER,    /* driver on for longer than the telegram             */
    SEG_UNASKED,   /* the station spoke without a good request to it     */
    SEG_MALFORMED, /* not one of the five formats, wrong FCS, cut short  */
    SEG_RULES
};

#define SEG_LEVELS 32768u

struct seg_party {
    const char *name;
    hv_time bit; /* its rate; 0: as the segment */
    bool judged;
    void (*hears)(struct seg_party *self, uint8_t octet, uint8_t err); /* end of stop bit; may be 0 */
    void *of;
    /* from here on the segment's own */
    struct seg_party *next;
    bool pending, spoilt, by_level; /* the character on its way: */
    uint8_t octet, err;
    hv_time char_end;
    uint8_t frame[TG_MAX + 1]; /* the telegram so far */
    unsigned n;
    hv_time frame_start, idle_before; /* line idle before frame[0] */
    bool asked;                       /* frame[0] came after a request that wants an answer */
    struct uart_wave wave;            /* what a receiver of another rate hears it from */
    uint8_t level[SEG_LEVELS];
    hv_time wave_start, resume, rx_bit;
    uint32_t waves;
    bool hearing;
};

struct seg_violation {
    enum seg_rule rule;
    const char *who;
    hv_time at;
    hv_time tbit; /* the measured time, where there is one */
};

/* A silent line at bit_per_s with the station on it. Call after hv_begin(). The station's address: what the
 * judge takes as a request to it. */
void seg_begin(uint32_t bit_per_s, uint8_t station_address);
void seg_set_address(uint8_t station_address);
void seg_set_rate(uint32_t bit_per_s);
/* 11 unless Set_Prm said otherwise; the judge does not read Set_Prm. max_T_SDR follows the rate. */
void seg_set_min_t_sdr(unsigned tbit);
unsigned seg_max_t_sdr(void);

void seg_attach(struct seg_party *party);

/* Power fails at the station: a telegram cut short now is not its fault. */
void seg_station_off(void);

/* How the station reaches the segment; seg_begin() connects it. */
extern const struct hv_wire seg_wire;

/* Send octets gap-free from time t (now or later) at the party's rate. err, if not 0, has one HAL_ERR_ value
 * for each octet: how it is to arrive. */
void seg_send(struct seg_party *from, hv_time t, const uint8_t *octets, unsigned n, const uint8_t *err);

/* Put bare levels on the line now, one bit time each (n <= SEG_LEVELS). Only the station hears them. */
void seg_send_levels(struct seg_party *from, const uint8_t *level, unsigned n);

/* End of the last octet on the line; what the station said last and when (start of its first bit). */
hv_time seg_quiet_since(void);
struct seg_said {
    uint8_t octets[TG_MAX];
    unsigned n;
    hv_time start, end;
    hv_time t_sdr;      /* idle before it, in ticks */
    unsigned telegrams; /* number of telegrams since seg_begin() */
};
extern struct seg_said seg_said;

/* Called for every finished telegram on the line, good or not; may be 0. */
extern void (*seg_trace)(const char *who, hv_time start, const uint8_t *octets, unsigned n);

/* What was judged. seg_verdict() describes the first violation since the last call, or is NULL; it also looks
 * whether the driver is still on, or a telegram unfinished, now. */
unsigned seg_count(enum seg_rule rule);
const char *seg_verdict(void);

#endif
