/* A master's line in real time: an initiator or a whole DP master over a pty or serial line.
 * Times are the initiator's: 1/576 us. */
#ifndef SIM_MASTER_LINE_H
#define SIM_MASTER_LINE_H

#include "sim/initiator.h"

#include <stdio.h>

struct master_line {
    int fd;
    uint32_t rate;
    FILE *record;               /* NULL: none */
    uint64_t zero, record_zero; /* [ns] */
};

#define ML_MS 576000u

/* Open the line and fill ini's bit, slot, gap, send, of. slot_ms: how long an answer may take to begin.
 * -> NULL, or what is wrong. */
const char *ml_open(struct master_line *l, const char *path, uint32_t rate, unsigned slot_ms,
                    struct ini *ini);
void ml_close(struct master_line *l);

/* Keep what is said as a record for fieldling-mon. */
bool ml_record(struct master_line *l, const char *path);

uint64_t ml_now(const struct master_line *l);

/* Wait until octets come, `until`, or input on `also` (-1: none); give octets to hear(). -> 1 octets or time, 2 `also`
 * is readable, -1: the line has gone. */
int ml_wait(struct master_line *l, uint64_t until, int also,
            void (*hear)(void *of, uint64_t now, uint8_t octet), void *of);

/* Ask one question and wait for the end of it. -> INI_DONE, INI_LOST, or INI_IDLE: the line has gone. */
enum ini_event ml_ask(struct master_line *l, struct ini *ini, const struct tg *request);

#endif
