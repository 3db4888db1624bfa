/* Modbus RTU and ASCII in words. Source: application protocol V1.1b3, serial line V1.02. */
#include "sim/mon.h"

#include <ctype.h>
#include <string.h>

#define WRONG(...) ((void)snprintf(f->wrong, sizeof f->wrong, __VA_ARGS__))

static unsigned u16be(const uint8_t *o)
{
    return (unsigned)(o[0] << 8 | o[1]);
}

/* ---- frames --------------------------------------------------------------------------------------------- */

static unsigned modbus_crc(const uint8_t *o, unsigned n)
{
    unsigned crc = 0xFFFF;
    for (unsigned i = 0; i < n; i++) {
        crc ^= o[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xA001 : crc >> 1;
    }
    return crc;
}

static void judge_rtu(struct mon_frame *f)
{
    if (f->n < 4 || f->n > 256) {
        WRONG("%u octets, a frame has 4 to 256", f->n);
        return;
    }
    const unsigned crc = modbus_crc(f->octets, f->n - 2);
    const unsigned sent = (unsigned)(f->octets[f->n - 1] << 8 | f->octets[f->n - 2]);
    if (crc != sent)
        WRONG("CRC is %04X, right is %04X", sent, crc);
    f->good = crc == sent;
}

static int hex(uint8_t c)
{
    return isdigit(c) ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* ':' pairs CR LF -> octets with the LRC; -1: not that. */
static int ascii_octets(const struct mon_frame *f, uint8_t *o)
{
    if (f->n < 9 || f->n > 513 || f->octets[0] != ':' || f->octets[f->n - 2] != '\r' ||
        f->octets[f->n - 1] != '\n')
        return -1;
    for (unsigned i = 1; i + 2 < f->n; i += 2) {
        if (i + 3 >= f->n || hex(f->octets[i]) < 0 || hex(f->octets[i + 1]) < 0)
            return -1;
        o[i / 2] = (uint8_t)(hex(f->octets[i]) << 4 | hex(f->octets[i + 1]));
    }
    return (int)(f->n - 3) / 2;
}

static void judge_ascii(struct mon_frame *f)
{
    uint8_t o[MON_FRAME_MAX];
    unsigned sum = 0;
    const int n = ascii_octets(f, o);
    for (int i = 0; i + 1 < n; i++)
        sum += o[i];
    if (n < 0)
        WRONG("not : hexadecimal pairs CR LF");
    else if (o[n - 1] != (-sum & 0xFF))
        WRONG("LRC is %02X, right is %02X", o[n - 1], -sum & 0xFF);
    f->good = n > 0 && !f->wrong[0];
}

/* Address, function and data of either mode. */
static unsigned modbus_pdu(const struct mon_frame *f, uint8_t *o)
{
    if (mon.protocol == MON_MODBUS_ASCII)
        return (unsigned)ascii_octets(f, o) - 1;
    memcpy(o, f->octets, f->n);
    return f->n - 2;
}

static const char *modbus_function(uint8_t function)
{
    static const struct {
        uint8_t code;
        const char *name;
    } names[] = {{1, "Read Coils"},
                 {2, "Read Discrete Inputs"},
                 {3, "Read Holding Registers"},
                 {4, "Read Input Registers"},
                 {5, "Write Single Coil"},
                 {6, "Write Single Register"},
                 {7, "Read Exception Status"},
                 {8, "Diagnostics"},
                 {11, "Get Comm Event Counter"},
                 {12, "Get Comm Event Log"},
                 {15, "Write Multiple Coils"},
                 {16, "Write Multiple Registers"},
                 {17, "Report Slave ID"},
                 {20, "Read File Record"},
                 {21, "Write File Record"},
                 {22, "Mask Write Register"},
                 {23, "Read/Write Multiple Registers"},
                 {24, "Read FIFO Queue"},
                 {43, "Encapsulated Interface"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (names[i].code == function)
            return names[i].name;
    return "user-defined function";
}

static const char *modbus_exception(uint8_t code)
{
    static const char *const names[9] = {NULL,
                                         "illegal function",
                                         "illegal data address",
                                         "illegal data value",
                                         "slave device failure",
                                         "acknowledge",
                                         "slave device busy",
                                         "negative acknowledge",
                                         "memory parity error"};
    return code > 0 && code < 9 ? names[code] : "unknown code";
}

void mon_modbus_judge(struct mon_frame *f)
{
    (mon.protocol == MON_MODBUS_RTU ? judge_rtu : judge_ascii)(f);
}

/* ---- request and answer ----------------------------------------------------------------------------------- */

/* The same function from the same address, right after a request, answers it; a broadcast is not answered. */
void mon_modbus_pair(struct mon_frame *f)
{
    static struct {
        uint8_t address, function;
        uint64_t end;
    } open;
    uint8_t o[MON_FRAME_MAX];
    modbus_pdu(f, o);
    f->answer = f->paired = o[0] && open.address == o[0] && open.function == (o[1] & 0x7F);
    if (f->answer) {
        f->timed = f->start >= open.end;
        f->t_sdr = f->timed ? f->start - open.end : 0;
        open.address = 0;
    } else {
        open.address = o[0];
        open.function = o[1];
        open.end = f->end;
    }
}

void mon_modbus_line(FILE *to, const struct mon_frame *f)
{
    uint8_t o[MON_FRAME_MAX];
    modbus_pdu(f, o);
    fprintf(to, f->answer ? "%u -> 0 MB res. %s" : "0 -> %u MB req. %s", o[0], modbus_function(o[1] & 0x7F));
    if (o[1] & 0x80)
        fprintf(to, ", exception %02X, %s", o[2], modbus_exception(o[2]));
    if (o[0] == 0)
        fprintf(to, " (broadcast)");
}

/* ---- content ------------------------------------------------------------------------------------------------ */

static FILE *out;

static void name(const char *text)
{
    fprintf(out, "        %-22s ", text);
}

static void number(const char *text, unsigned value)
{
    name(text);
    fprintf(out, "%u\n", value);
}

static void octets(const char *text, const uint8_t *o, unsigned n)
{
    name(text);
    for (unsigned i = 0; i < n; i++)
        fprintf(out, "%s%02X", i ? " " : "", o[i]);
    fprintf(out, "\n");
}

static void registers(const uint8_t *o, unsigned n)
{
    name("registers");
    for (unsigned i = 0; i + 1 < n; i += 2)
        fprintf(out, "%s%u", i ? " " : "", u16be(o + i));
    fprintf(out, "\n");
}

/* Lowest bit of the first octet is the first item. */
static void bits(const uint8_t *o, unsigned n)
{
    name("bits, first on the left");
    for (unsigned i = 0; i < 8 * n; i++)
        fprintf(out, "%s%u", i && i % 8 == 0 ? " " : "", o[i / 8] >> i % 8 & 1u);
    fprintf(out, "\n");
}

/* d[0..n-1] is what follows the function code. -> false: not a shape that is known here. */
static bool request(uint8_t function, const uint8_t *d, unsigned n)
{
    if (function == 22 && n == 6) {
        number("address", u16be(d));
        octets("and mask", d + 2, 2);
        octets("or mask", d + 4, 2);
        return true;
    }
    if (function == 23 && n >= 9) {
        number("read address", u16be(d));
        number("read quantity", u16be(d + 2));
        number("write address", u16be(d + 4));
        registers(d + 9, n - 9);
        return true;
    }
    if (function == 8 && n >= 2) {
        number("sub-function", u16be(d));
        octets("data", d + 2, n - 2);
        return true;
    }
    if (n < 4 || !((function >= 1 && function <= 6) || function == 15 || function == 16))
        return false;
    number("address", u16be(d));
    if (function == 5)
        name("coil"), fprintf(out, "%s\n",
                              u16be(d + 2) == 0xFF00 ? "ON"
                              : u16be(d + 2)         ? "neither ON nor OFF"
                                                     : "OFF");
    else
        number(function == 6 ? "value" : "quantity", u16be(d + 2));
    if (function == 15 && n > 5)
        bits(d + 5, n - 5);
    if (function == 16 && n > 5)
        registers(d + 5, n - 5);
    return true;
}

static bool answer(uint8_t function, const uint8_t *d, unsigned n)
{
    const bool counted = n >= 1 && d[0] == n - 1;
    if (counted && (function == 1 || function == 2))
        bits(d + 1, n - 1);
    else if (counted && (function == 3 || function == 4 || function == 23))
        registers(d + 1, n - 1);
    else if (function == 5 || function == 6 || function == 8 || function == 15 || function == 16 ||
             function == 22)
        return request(function, d, n); /* an echo, or its head */
    else
        return false;
    return true;
}

void mon_modbus_details(FILE *to, const struct mon_frame *f)
{
    uint8_t o[MON_FRAME_MAX];
    const unsigned n = modbus_pdu(f, o);
    out = to;
    name("function");
    fprintf(to, "%02X\n", o[1]);
    if (f->timed)
        name("response time"), fprintf(to, "%.3f ms\n", (double)f->t_sdr / 1e6);
    if (!(o[1] & 0x80) && !(f->answer ? answer : request)(o[1], o + 2, n - 2) && n > 2)
        octets("data", o + 2, n - 2);
}
