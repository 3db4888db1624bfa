/* The console of a host station: standard input and output. The station never waits for it, and the end of
 * the input is not the end of the station: it may run as a service with no console at all. */
#include "hal/hal.h"
#include "hal_host.h"

#include <errno.h>
#include <poll.h>
#include <unistd.h>

static struct {
    uint8_t in[256];
    size_t in_at, in_end;
    bool eof;
    char out[2048];
    size_t out_n;
} con;

int con_input(void)
{
    return con.eof || con.in_at < con.in_end ? -1 : STDIN_FILENO;
}

void con_read(void)
{
    ssize_t n = read(STDIN_FILENO, con.in, sizeof con.in);

    con.in_at = 0;
    con.in_end = n > 0 ? (size_t)n : 0;
    con.eof = n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
}

int16_t hal_con_get(void)
{
    return con.in_at < con.in_end ? con.in[con.in_at++] : -1;
}

/* Whole lines. A line is dropped when nobody takes it. */
void hal_con_put(uint8_t octet)
{
    struct pollfd p = {.fd = STDOUT_FILENO, .events = POLLOUT};
    ssize_t written = 0;

    con.out[con.out_n++] = (char)octet;
    if (octet != '\n' && con.out_n < sizeof con.out)
        return;
    if (poll(&p, 1, 0) > 0 && (p.revents & POLLOUT))
        written = write(STDOUT_FILENO, con.out, con.out_n);
    (void)written; /* nobody there to tell */
    con.out_n = 0;
}
