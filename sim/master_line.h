/* A master's line: an initiator or a whole DP master over a pty or serial line in real time, or on a
 * simulated segment in this process. Times are the initiator's: 1/576 us. */
#ifndef SIM_MASTER_LINE_H
#define SIM_MASTER_LINE_H

#include "sim/initiator.h"

#include <stdio.h>

struct master_line;
struct ml_view;

/* A kind of line. The functions are those below; open() fills ini's slot, gap, untimed, send, too. */
struct ml_kind {
    const char *(*open)(struct master_line *l, const char *path, unsigned slot_ms, struct ini *ini);
    void (*close)(struct master_line *l);
    uint64_t (*now)(const struct master_line *l);
    int (*wait)(struct master_line *l, uint64_t until, int also,
                void (*hear)(void *of, uint64_t now, uint8_t octet), void *of);
    const struct ml_view
        *view; /* what a class 1 master shows of the line's other end (sim/master.h), or NULL */
};

/* "sim:" or "sim:ADDRESS": a segment in virtual time, paced to real time, with DP-TEST01 on it. It is not here
 * but in boards/posix/dp_sim_line.c, because a station is firmware. */
#define ML_SIM "sim:"
extern const struct ml_kind ml_sim;

struct master_line {
    const struct ml_kind *kind;
    uint32_t rate;
    bool untimed;         /* times are this computer's, not the line's */
    FILE *record;         /* NULL: none */
    uint64_t record_zero; /* [ns] */
    /* of a pty or serial line */
    int fd;
    uint64_t zero; /* [ns] */
};

#define ML_MS 576000u

/* Open the line and fill ini's bit, slot, gap, untimed, send, of. slot_ms: how long an answer may take to
 * begin; the simulated segment keeps to the standard's slot time instead. -> NULL, or what is wrong. */
const char *ml_open(struct master_line *l, const char *path, uint32_t rate, unsigned slot_ms,
                    struct ini *ini);
void ml_close(struct master_line *l);

/* Keep what is said as a record for fieldling-mon. */
bool ml_record(struct master_line *l, const char *path);

/* Octets were on the line from time `at` on: into the record, if there is one. For a kind of line. */
void ml_said(struct master_line *l, uint64_t at, const uint8_t *octets, unsigned n);

uint64_t ml_now(const struct master_line *l);

/* Wait until octets come, `until`, or input on `also` (-1: none); give octets to hear(). -> 1 octets or time, 2 `also`
 * is readable, -1: the line has gone. */
int ml_wait(struct master_line *l, uint64_t until, int also,
            void (*hear)(void *of, uint64_t now, uint8_t octet), void *of);

/* Ask one question and wait for the end of it. -> INI_DONE, INI_LOST, or INI_IDLE: the line has gone. */
enum ini_event ml_ask(struct master_line *l, struct ini *ini, const struct tg *request);

#endif
