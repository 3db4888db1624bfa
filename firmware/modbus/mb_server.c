/* Modbus server: one request in, one answer out, whatever the line was.
 *
 * Layer    mb_line -> [mb_server] -> handlers (mb_read, mb_write, ...) -> mb_data -> application
 * Context  main
 * Source   [A] 6 and figure 9; [S] appendix A for what is counted where
 */
#include "modbus/mb_diag.h"
#include "modbus/mb_line.h"

#define EXCEPTION_FLAG 0x80u

struct mb_row {
    uint8_t code, octets, how;
    uint8_t (*handler)(void);
};

#define MB_DECLARE(code, handler, octets, how) uint8_t handler(void);
#define MB_ROW(code, handler, octets, how)     {code, octets, how, handler},

MB_FUNCTIONS(MB_DECLARE)

static uint8_t unknown(void)
{
    return MB_ILLEGAL_FUNCTION;
}

static const struct mb_row CODE rows[] = {MB_FUNCTIONS(MB_ROW){0, 0, MB_LEAST, unknown}};

/* The last row serves all other codes. */
static const struct mb_row CODE *find(uint8_t code)
{
    const struct mb_row CODE *row = rows;
    while (row->code && row->code != code)
        row++;
    return row;
}

/* [A] leaves open when a wrong length is found out; [S] appendix A and [A] 7 ("the implied length is
 * incorrect") make it exception 3, and here it comes before all that a handler looks at. */
static uint8_t execute(void)
{
    const struct mb_row CODE *row = find(mb_pdu[0]);
    uint8_t more;
    if (mb_adu[0] == 0 && !(row->how & MB_BROADCAST))
        return MB_ILLEGAL_FUNCTION; /* counted, never answered */
    if (mb_pdu_len < row->octets)
        return MB_ILLEGAL_VALUE;
    more = (uint8_t)(mb_pdu_len - row->octets);
    if (row->how & MB_COUNTED)
        more = (uint8_t)(more - mb_pdu[row->octets - 1u]); /* both 0..255: 0 only if they are the same */
    if (more && !(row->how & MB_LEAST))
        return MB_ILLEGAL_VALUE;
    return row->handler();
}

void mb_poll(void)
{
    bool answered;
    uint8_t exception = MB_OK;
    if (MB_HAS_DIAGNOSTICS)
        mb_diag_poll();
    if (mb_is_ascii)
        mb_ascii_poll();
    if (mb_rx.state != MB_READY)
        return;
    if (!MB_HAS_DIAGNOSTICS || mb_diag_begin())
        exception = execute();
    answered = mb_adu[0] != 0;
    if (MB_HAS_DIAGNOSTICS) {
        answered &= !mb_diag.listen_only;
        mb_diag_end(exception, answered);
    }
    if (exception) {
        mb_pdu[0] |= EXCEPTION_FLAG;
        mb_pdu[1] = exception;
        mb_pdu_len = 2;
    }
    mb_line_end(answered);
}
