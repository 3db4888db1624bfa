#include "sim/initiator.h"

#include <string.h>

enum { IDLE, WAIT_SYN, SENDING, WAIT_ANSWER, HEARING, GOOD };

void ini_begin(struct ini *i)
{
    i->state = IDLE;
    i->due = INI_NEVER;
    i->quiet = 0;
    i->in_n = 0;
    i->sent = i->resent = i->lost = i->strange = 0;
    memset(i->next_fcb, TG_FCB, sizeof i->next_fcb);
}

void ini_forget(struct ini *i, uint8_t station)
{
    i->next_fcb[station & 127] = TG_FCB;
}

static void start(struct ini *i, uint64_t now)
{
    const uint64_t syn = i->quiet + 33 * i->bit;
    i->tries = 0;
    i->state = WAIT_SYN;
    i->due = syn > now ? syn : now;
}

void ini_ask(struct ini *i, uint64_t now, const struct tg *request)
{
    const uint8_t function = request->fc & 0x0F;
    i->request = *request;
    i->request.sa = i->address;
    i->request.fc = (uint8_t)(TG_REQUEST | function);
    i->fcb_counts =
        function == TG_SRD_L || function == TG_SRD_H || function == TG_SDA_L || function == TG_SDA_H;
    if (i->fcb_counts)
        i->request.fc |= i->next_fcb[request->da & 127];
    i->out_n = tg_encode(&i->request, i->out);
    i->wants_answer = tg_wants_answer(&i->request);
    start(i, now);
}

void ini_tell(struct ini *i, uint64_t now, const uint8_t *octets, unsigned n)
{
    memcpy(i->out, octets, n);
    i->out_n = n;
    i->wants_answer = i->fcb_counts = false;
    start(i, now);
}

void ini_activity(struct ini *i, uint64_t now)
{
    i->quiet = now;
    if (i->state == WAIT_SYN)
        i->due = now + 33 * i->bit;
}

void ini_sends_until(struct ini *i, uint64_t end)
{
    if (end > i->sent_end)
        i->sent_end = i->quiet = i->due = end;
}

void ini_hear(struct ini *i, uint64_t now, uint8_t octet, uint8_t err)
{
    ini_activity(i, now);
    if (i->state == SENDING && i->untimed && i->wants_answer) {
        i->state = WAIT_ANSWER;
        i->sent_end = now;
    }
    if (i->state != WAIT_ANSWER && i->state != HEARING)
        return;
    if (i->state == WAIT_ANSWER) {
        i->answer_time = now - i->sent_end;
        i->in_n = 0;
        i->spoilt = false;
        i->state = HEARING;
    }
    i->spoilt = i->spoilt || err || i->in_n > TG_MAX - 1;
    if (!i->spoilt)
        i->in[i->in_n++] = octet;
    i->due = now + i->gap;
    if (!i->spoilt && tg_decode(i->in, i->in_n, &i->answer) == TG_GOOD) {
        i->state = GOOD;
        i->due = now;
    }
}

uint64_t ini_due(const struct ini *i)
{
    return i->due;
}

/* FCB toggles when an answer has come: after the first request FCV = 1, FCB = 0. */
static void toggle(struct ini *i)
{
    uint8_t *const next = &i->next_fcb[i->request.da & 127];
    if (i->fcb_counts)
        *next = *next == TG_FCB ? TG_FCV : (uint8_t)(*next ^ TG_FCB);
}

static bool is_our_answer(const struct ini *i)
{
    const struct tg *const a = &i->answer;
    if (a->sd == TG_SC)
        return true;
    return a->sd != TG_SD4 && !(a->fc & TG_REQUEST) && a->da == i->address && a->sa == i->request.da;
}

static enum ini_event finish(struct ini *i, enum ini_event how)
{
    i->state = IDLE;
    i->due = INI_NEVER;
    return how;
}

static enum ini_event again_or_lost(struct ini *i, uint64_t now)
{
    if (i->tries <= i->retries) {
        const uint64_t syn = i->quiet + 33 * i->bit;
        i->state = WAIT_SYN;
        i->due = syn > now ? syn : now;
        return INI_BUSY;
    }
    i->lost++;
    if (i->fcb_counts)
        ini_forget(i, i->request.da);
    return finish(i, INI_LOST);
}

static void transmit(struct ini *i, uint64_t now)
{
    i->sent++;
    i->resent += i->tries > 0;
    i->tries++;
    i->sent_end = i->quiet = i->due = now + i->out_n * 11 * i->bit;
    i->state = SENDING;
    i->send(i->of, i->out, i->out_n);
}

enum ini_event ini_poll(struct ini *i, uint64_t now)
{
    if (i->state == IDLE)
        return INI_IDLE;
    if (now < i->due)
        return INI_BUSY;
    switch (i->state) {
    case WAIT_SYN:
        transmit(i, now);
        return INI_BUSY;
    case SENDING:
        if (!i->wants_answer)
            return finish(i, INI_DONE);
        i->state = WAIT_ANSWER;
        i->due = now + i->slot;
        return INI_BUSY;
    case GOOD:
        if (is_our_answer(i)) {
            toggle(i);
            return finish(i, INI_DONE);
        }
        break;
    default:
        break;
    }
    i->strange += i->state != WAIT_ANSWER;
    return again_or_lost(i, now);
}
