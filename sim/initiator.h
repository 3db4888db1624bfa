/* The asking side of a fieldbus data link: one request at a time, T_SYN before it, slot time, retries, FCB.
 *
 * Knows no clock and no line: time comes in with each call, in ticks of 1/576 us, and octets go out and come
 * in through functions. So the same object drives virtual time and a pty.
 *
 * Source: EN 50170-2 part 4, 4.1 (times), 4.3 (FCB); facts, section 3.3.
 */
#ifndef SIM_INITIATOR_H
#define SIM_INITIATOR_H

#include "sim/telegram.h"

#define INI_NEVER UINT64_MAX

enum ini_event { INI_IDLE, INI_BUSY, INI_DONE, INI_LOST };

struct ini {
    /* set by the user before ini_begin() */
    uint8_t address;
    uint64_t bit;  /* ticks */
    uint64_t slot; /* [ticks] how long an answer may take to begin */
    uint64_t gap;  /* [ticks] idle that ends a telegram: 33 T_bit on a wire, milliseconds on a pty */
    unsigned retries;
    bool untimed;  /* a pty: the answer may come before the request's time on a wire is over */
    void (*send)(void *of, const uint8_t *octets, unsigned n); /* put on the line now */
    void *of;
    /* results */
    struct tg answer;     /* after INI_DONE, unless the request wanted none */
    uint64_t answer_time; /* [ticks] from the end of the request to the end of the answer's first octet */
    unsigned sent, resent, lost, strange; /* requests, retries, given up, answers that were none */
    /* own */
    uint8_t state;
    bool wants_answer, fcb_counts;
    struct tg request;
    uint8_t out[TG_MAX];
    unsigned out_n, tries;
    uint64_t quiet, due, sent_end;
    uint8_t in[TG_MAX + 1];
    unsigned in_n;
    bool spoilt;
    uint8_t next_fcb[128]; /* FCB and FCV of the next request to that station */
};

void ini_begin(struct ini *i);

/* Ask. The request's FC holds the function only; SRD and SDA get FCB and FCV. Only when INI_IDLE. */
void ini_ask(struct ini *i, uint64_t now, const struct tg *request);

/* Send octets as they are, expecting no answer (a token, for instance). Only when INI_IDLE. */
void ini_tell(struct ini *i, uint64_t now, const uint8_t *octets, unsigned n);

/* An octet from the line, our own excepted; err != 0: damaged. */
void ini_hear(struct ini *i, uint64_t now, uint8_t octet, uint8_t err);

/* The line is not idle, though nothing can be read. */
void ini_activity(struct ini *i, uint64_t now);

/* The request takes until then to leave, longer than its octets say. For the send function. */
void ini_sends_until(struct ini *i, uint64_t end);

/* When ini_poll() has something to do: call it then. After INI_DONE and INI_LOST the initiator is idle. */
uint64_t ini_due(const struct ini *i);
enum ini_event ini_poll(struct ini *i, uint64_t now);

/* Forget the FCB of a station: the next request to it is a first one. */
void ini_forget(struct ini *i, uint8_t station);

#endif
