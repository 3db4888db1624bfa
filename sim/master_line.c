#include "sim/master_line.h"

#include "sim/port.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

/* ---- a pty or serial line ------------------------------------------------------------------------------- */

static void send_octets(void *of, const uint8_t *octets, unsigned n)
{
    struct master_line *const l = of;
    ml_said(l, ml_now(l), octets, n);
    while (n) {
        const ssize_t done = write(l->fd, octets, n);
        struct pollfd p = {l->fd, POLLOUT, 0};
        if (done > 0) {
            octets += done;
            n -= (unsigned)done;
        } else if (done < 0 && errno != EAGAIN) {
            return; /* reading will tell */
        } else if (poll(&p, 1, 1000) <= 0) {
            return;
        }
    }
}

static const char *tty_open(struct master_line *l, const char *path, unsigned slot_ms, struct ini *ini)
{
    const char *why = NULL;
    l->fd = port_open(path, l->rate, PORT_8E1, &why);
    if (l->fd < 0)
        return why;
    l->zero = port_steady();
    ini->slot = slot_ms * (uint64_t)ML_MS;
    ini->gap = 5 * (uint64_t)ML_MS;
    ini->untimed = true;
    ini->send = send_octets;
    return NULL;
}

static void tty_close(struct master_line *l)
{
    close(l->fd);
}

static uint64_t tty_now(const struct master_line *l)
{
    return (port_steady() - l->zero) * 576 / 1000;
}

static int tty_wait(struct master_line *l, uint64_t until, int also,
                    void (*hear)(void *of, uint64_t now, uint8_t octet), void *of)
{
    uint8_t octets[512];
    fd_set readable;
    const uint64_t now = ml_now(l);
    uint64_t ns = until <= now ? 0 : (until - now) * 1000 / 576;
    if (ns > 200000000)
        ns = 200000000;
    const struct timespec timeout = {(time_t)(ns / 1000000000), (long)(ns % 1000000000)};
    FD_ZERO(&readable);
    FD_SET(l->fd, &readable);
    if (also >= 0)
        FD_SET(also, &readable);
    const int ready = pselect((also > l->fd ? also : l->fd) + 1, &readable, NULL, NULL, &timeout, NULL);
    if (ready > 0 && FD_ISSET(l->fd, &readable)) {
        const ssize_t n = read(l->fd, octets, sizeof octets);
        if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR))
            return -1;
        if (n > 0)
            ml_said(l, ml_now(l), octets, (unsigned)n);
        for (ssize_t i = 0; i < n; i++)
            hear(of, ml_now(l), octets[i]);
    }
    return ready > 0 && also >= 0 && FD_ISSET(also, &readable) ? 2 : 1;
}

static const struct ml_kind ml_tty = {tty_open, tty_close, tty_now, tty_wait, NULL};

/* ---- any line --------------------------------------------------------------------------------------------- */

const char *ml_open(struct master_line *l, const char *path, uint32_t rate, unsigned slot_ms, struct ini *ini)
{
    const bool sim = strncmp(path, ML_SIM, sizeof ML_SIM - 1) == 0;
    *l = (struct master_line){.kind = sim ? &ml_sim : &ml_tty, .rate = rate, .record_zero = port_now()};
    ini->bit = 576000000u / rate;
    ini->of = l;
    const char *const bad = l->kind->open(l, path, slot_ms, ini);
    l->untimed = ini->untimed;
    return bad;
}

void ml_close(struct master_line *l)
{
    if (l->record)
        fclose(l->record);
    l->kind->close(l);
}

bool ml_record(struct master_line *l, const char *path)
{
    l->record = fopen(path, "w");
    if (l->record)
        fprintf(l->record, "%s# rate %u\n", l->untimed ? "# untimed\n" : "", l->rate);
    return l->record != NULL;
}

void ml_said(struct master_line *l, uint64_t at, const uint8_t *octets, unsigned n)
{
    if (!l->record)
        return;
    const uint64_t t = l->record_zero + at * 1000 / 576;
    fprintf(l->record, "%llu.%09llu", (unsigned long long)(t / 1000000000),
            (unsigned long long)(t % 1000000000));
    for (unsigned i = 0; i < n; i++)
        fprintf(l->record, " %02X", octets[i]);
    fprintf(l->record, "\n");
}

uint64_t ml_now(const struct master_line *l)
{
    return l->kind->now(l);
}

int ml_wait(struct master_line *l, uint64_t until, int also,
            void (*hear)(void *of, uint64_t now, uint8_t octet), void *of)
{
    return l->kind->wait(l, until, also, hear, of);
}

static void hear_ini(void *of, uint64_t now, uint8_t octet)
{
    ini_hear(of, now, octet, 0);
}

enum ini_event ml_ask(struct master_line *l, struct ini *ini, const struct tg *request)
{
    enum ini_event event;
    ini_ask(ini, ml_now(l), request);
    while ((event = ini_poll(ini, ml_now(l))) == INI_BUSY)
        if (ml_wait(l, ini_due(ini), -1, hear_ini, ini) < 0)
            return INI_IDLE;
    return event;
}
