/* HDLC primary, normal response mode, window 1, for a line of remote modules: connects, polls by scan time, carries out
 * requests exactly once, recovers. Frames in and out, time in milliseconds from the caller; no line, no clock, no
 * code of firmware/.
 *
 *     hp_init; hp_add ...      then for ever:   hp_frame(each frame received), hp_poll(now)
 *
 * One exchange at a time is on the line: a command with P=1, and its answer or a time-out. After a time-out the
 * next module has its turn; the lost exchange is repeated when the module's own turn comes.
 */
#ifndef SIM_HDLC_PRIMARY_H
#define SIM_HDLC_PRIMARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define HP_MODULES  31u
#define HP_CHANNELS 16u
#define HP_INFO     64u
#define HP_QUEUE    64u

enum hp_type { HP_DI = 1, HP_DO = 2, HP_AI = 4, HP_AO = 8 };

enum hp_state {
    HP_DISABLED, /* the operator does not want it polled             */
    HP_OFFLINE,  /* does not answer, or not connected yet             */
    HP_ONLINE,   /* connected; document mode: the last poll was answered */
};

enum hp_outcome {
    HP_DONE,       /* carried out; here is the answer                                        */
    HP_REFUSED,    /* negative answer: function+80H channel reason                            */
    HP_NOT_SENT,   /* the module does not answer; it was certainly not carried out            */
    HP_UNKNOWN,    /* sent, but the connection was lost before an answer: may have been done   */
};

/* What is asked of a module: the information field of a command. */
struct hp_request {
    uint32_t id; /* 0: a scan */
    uint8_t module, n, info[HP_INFO];
};

struct hp_counters {
    uint32_t commands, answers, timeouts, repeats, connects, frmr, dm, rej, rnr, duplicates, strange, refused;
};

struct hp_module {
    /* configuration */
    char name[24];
    uint8_t address;
    enum hp_type type;
    bool document;   /* control 08H/09H, never connected */
    uint32_t scan_ms; /* 0: not scanned                  */
    uint16_t channels; /* bit i: channel index i is scanned */

    /* what is known */
    enum hp_state state;
    uint16_t value[HP_CHANNELS];
    uint16_t valid;            /* bit i: value[i] is an answer of this connection */
    uint16_t error;            /* bit i: the last answer for it was negative      */
    uint64_t answered_ms;
    struct hp_counters count;

    /* own */
    uint8_t vs, vr, misses, next_channel;
    bool has_request, sent, acked, must_poll, leaving;
    struct hp_request request;
    uint64_t due_ms, again_ms;
};

struct hp {
    /* set after hp_init() */
    uint32_t timeout_ms; /* from the end of a command to the end of its answer; default 250 */
    uint32_t retry_ms;   /* an offline module is tried this often; default 1000             */
    uint8_t misses_max;  /* time-outs in a row before a module is offline; default 3        */
    void *user;
    void (*send)(struct hp *p, const uint8_t *octets, unsigned n);
    /* A request has come to its end. answer[0..n-1]: information field. NULL: nobody listens. */
    void (*done)(struct hp *p, struct hp_module *m, const struct hp_request *r, enum hp_outcome outcome,
                 const uint8_t *answer, unsigned n);
    /* Something went wrong, for the operator. NULL: nobody listens. */
    void (*trouble)(struct hp *p, struct hp_module *m, const char *what);

    struct hp_module module[HP_MODULES];
    unsigned modules;

    /* own */
    struct hp_request queue[HP_QUEUE];
    unsigned queue_at, queued;
    uint32_t last_id;
    bool waiting;
    unsigned turn; /* the module that has the line, or had it last */
    uint64_t now_ms, deadline_ms;
    enum hp_exchange { HP_X_SNRM, HP_X_DISC, HP_X_I, HP_X_RR, HP_X_DOCUMENT } exchange;
};

void hp_init(struct hp *p);

/* Add a module as configured (the first six members). -> NULL: full, or the address is taken. */
struct hp_module *hp_add(struct hp *p, const struct hp_module *configured);

/* Queue a request for module number `module` -> its id, 0: queue full or n too long. Requests come before scans, in
 * their order. */
uint32_t hp_ask(struct hp *p, unsigned module, const uint8_t *info, unsigned n);

/* Poll it, or no longer (a connected one is disconnected first: DISC). */
void hp_enable(struct hp *p, unsigned module, bool on);

/* A frame with good FCS has come. */
void hp_frame(struct hp *p, const uint8_t *octets, unsigned n, uint64_t now_ms);

/* Time goes by; the next command leaves when it is due. */
void hp_poll(struct hp *p, uint64_t now_ms);

/* The command handed to send() is out: from here the time-out counts. May be left out: from send() then. */
void hp_sent(struct hp *p, uint64_t now_ms);

unsigned hp_first_channel(enum hp_type type); /* 0, or 1 for analog: number of channel index 0 */
unsigned hp_channels(enum hp_type type);

#endif
