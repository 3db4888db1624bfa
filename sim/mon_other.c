/* Frames that are not PROFIBUS-DP: PA, Modbus RTU and ASCII, HDLC. A record's line is one frame of PA or HDLC, as modem
 * and chip deliver them: PA from SDL to CRC, HDLC between its flags with the FCS. */
#include "sim/mon.h"

#include <ctype.h>
#include <string.h>

#define WRONG(...) ((void)snprintf(f->wrong, sizeof f->wrong, __VA_ARGS__))

static unsigned u16be(const uint8_t *o)
{
    return (unsigned)(o[0] << 8 | o[1]);
}

/* ---- PROFIBUS-PA: facts, section 6 -------------------------------------------------------------------- */

static unsigned pa_crc(const uint8_t *o, unsigned n)
{
    unsigned crc = 0xFFFF;
    for (unsigned i = 0; i < n * 8; i++) {
        const unsigned in = o[i / 8] >> (7 - i % 8) & 1u;
        crc = (crc << 1 ^ ((crc >> 15 ^ in) & 1 ? 0x1DCF : 0)) & 0xFFFF;
    }
    return crc ^ 0xFFFF;
}

/* The same telegram as DP would send it: the sum and ED in place of the CRC. */
static void judge_pa(struct mon_frame *f)
{
    uint8_t dp[TG_MAX];
    unsigned n = f->n - 2;
    if (f->n < 3 || n + 2 > TG_MAX) {
        WRONG("%u octets", f->n);
        return;
    }
    memcpy(dp, f->octets, n);
    if (dp[0] != TG_SC && dp[0] != TG_SD4) {
        unsigned sum = 0;
        for (unsigned i = dp[0] == TG_SD2 ? 4 : 1; i < n; i++)
            sum += dp[i];
        dp[n++] = (uint8_t)sum;
        dp[n++] = TG_ED;
    }
    mon_judge_dp(dp, NULL, n, f->wrong, sizeof f->wrong);
    const unsigned crc = pa_crc(f->octets, f->n - 2), sent = u16be(f->octets + f->n - 2);
    if (!f->wrong[0] && crc != sent)
        WRONG("CRC is %04X, right is %04X", sent, crc);
    f->good = !f->wrong[0] && tg_decode(dp, n, &f->tg) == TG_GOOD;
}

/* ---- Modbus: application protocol V1.1b3, serial line V1.02 ---------------------------------------------- */

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
    if (f->n < 9 || f->n > 513 || f->octets[0] != ':' || f->octets[f->n - 2] != '\r' || f->octets[f->n - 1] != '\n')
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
    } names[] = {{1, "Read Coils"}, {2, "Read Discrete Inputs"}, {3, "Read Holding Registers"}, {4, "Read Input Registers"},
                 {5, "Write Single Coil"}, {6, "Write Single Register"}, {7, "Read Exception Status"}, {8, "Diagnostics"},
                 {11, "Get Comm Event Counter"}, {12, "Get Comm Event Log"}, {15, "Write Multiple Coils"},
                 {16, "Write Multiple Registers"}, {17, "Report Slave ID"}, {20, "Read File Record"},
                 {21, "Write File Record"}, {22, "Mask Write Register"}, {23, "Read/Write Multiple Registers"},
                 {24, "Read FIFO Queue"}, {43, "Encapsulated Interface"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (names[i].code == function)
            return names[i].name;
    return "user-defined function";
}

static const char *modbus_exception(uint8_t code)
{
    static const char *const names[9] = {NULL, "illegal function", "illegal data address", "illegal data value",
                                         "slave device failure", "acknowledge", "slave device busy",
                                         "negative acknowledge", "memory parity error"};
    return code > 0 && code < 9 ? names[code] : "unknown code";
}

/* Requests and answers are told apart by who spoke last: the same function from the same address answers. */
static void modbus_line(FILE *to, const struct mon_frame *f)
{
    static uint8_t open[2];
    uint8_t o[MON_FRAME_MAX];
    modbus_pdu(f, o);
    const bool answer = o[0] && open[0] == o[0] && open[1] == (o[1] & 0x7F);
    fprintf(to, answer ? "%u -> 0 MB res. %s" : "0 -> %u MB req. %s", o[0], modbus_function(o[1] & 0x7F));
    if (o[1] & 0x80)
        fprintf(to, ", exception %02X, %s", o[2], modbus_exception(o[2]));
    if (o[0] == 0)
        fprintf(to, " (broadcast)");
    open[0] = answer ? 0 : o[0];
    open[1] = answer ? 0 : o[1];
}

static void modbus_details(FILE *to, const struct mon_frame *f)
{
    uint8_t o[MON_FRAME_MAX];
    const unsigned n = modbus_pdu(f, o);
    fprintf(to, "        %-22s %02X\n", "function", o[1]);
    if (n == 6 && o[1] >= 1 && o[1] <= 6) {
        fprintf(to, "        %-22s %u\n", "address", u16be(o + 2));
        fprintf(to, "        %-22s %u\n", o[1] < 5 ? "quantity" : "value", u16be(o + 4));
    } else if (n > 2) {
        fprintf(to, "        %-22s", "data");
        for (unsigned i = 2; i < n; i++)
            fprintf(to, " %02X", o[i]);
        fprintf(to, "\n");
    }
}

/* ---- HDLC remote modules: spec C1, C2 --------------------------------------------------------------------- */

static unsigned hdlc_fcs(const uint8_t *o, unsigned n)
{
    unsigned crc = 0xFFFF;
    for (unsigned i = 0; i < n; i++) {
        crc ^= o[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0x8408 : crc >> 1;
    }
    return crc ^ 0xFFFF;
}

static void judge_hdlc(struct mon_frame *f)
{
    if (f->n < 4) {
        WRONG("%u octets, a frame has 4 at least", f->n);
        return;
    }
    const unsigned fcs = hdlc_fcs(f->octets, f->n - 2);
    const unsigned sent = (unsigned)(f->octets[f->n - 1] << 8 | f->octets[f->n - 2]);
    if (fcs != sent)
        WRONG("FCS is %04X, right is %04X", sent, fcs);
    f->good = fcs == sent;
}

/* ISO/IEC 13239, control field of modulo 8. */
static void hdlc_control(uint8_t c, char *text, size_t size)
{
    static const char *const supervisory[4] = {"RR", "RNR", "REJ", "SREJ"};
    static const struct {
        uint8_t code; /* without P/F */
        const char *name;
    } unnumbered[] = {{0x03, "UI"}, {0x0F, "DM/SARM"}, {0x43, "DISC/RD"}, {0x63, "UA"}, {0x83, "SNRM"}, {0x87, "FRMR"},
                      {0xAF, "XID"}, {0xE3, "TEST"}};
    const char *const pf = c & 0x10 ? ", P/F" : "";
    if ((c & 1) == 0) {
        snprintf(text, size, "I N(S)=%u N(R)=%u%s", c >> 1 & 7, c >> 5, pf);
    } else if ((c & 3) == 1) {
        snprintf(text, size, "%s N(R)=%u%s", supervisory[c >> 2 & 3], c >> 5, pf);
    } else {
        snprintf(text, size, "unnumbered %02X%s", c, pf);
        for (size_t i = 0; i < sizeof unnumbered / sizeof unnumbered[0]; i++)
            if (unnumbered[i].code == (c & 0xEF))
                snprintf(text, size, "%s%s", unnumbered[i].name, pf);
    }
}

static void hdlc_line(FILE *to, const struct mon_frame *f)
{
    char text[48];
    const uint8_t *const o = f->octets;
    if (f->n >= 6 && (o[1] == 0x08 || o[1] == 0x09) && (o[2] == 1 || o[2] == 2)) {
        fprintf(to, o[1] == 0x08 ? "0 -> %02X RM req. %s channel %02X" : "%02X -> 0 RM res. %s channel %02X", o[0],
                o[2] == 1 ? "Request data" : "Control", o[3]);
        return;
    }
    hdlc_control(o[1], text, sizeof text);
    fprintf(to, "%02X HDLC %s", o[0], text);
}

static void hdlc_details(FILE *to, const struct mon_frame *f)
{
    const uint8_t *const o = f->octets;
    char text[48];
    hdlc_control(o[1], text, sizeof text);
    fprintf(to, "        %-22s %02X %s\n", "control", o[1], text);
    if (f->n == 7 && (o[4] == 0x30 || o[4] == 0x31))
        fprintf(to, "        %-22s %s\n", "digital", o[4] == 0x31 ? "ON" : "OFF");
    else if (f->n == 8)
        fprintf(to, "        %-22s %u\n", "analog", u16be(o + 4));
}

/* ---- which ------------------------------------------------------------------------------------------------- */

void mon_judge_other(struct mon_frame *f)
{
    if (mon.protocol == MON_PA)
        judge_pa(f);
    else if (mon.protocol == MON_MODBUS_RTU)
        judge_rtu(f);
    else if (mon.protocol == MON_MODBUS_ASCII)
        judge_ascii(f);
    else
        judge_hdlc(f);
}

void mon_other_line(FILE *to, const struct mon_frame *f)
{
    (mon.protocol == MON_HDLC ? hdlc_line : modbus_line)(to, f);
}

void mon_other_details(FILE *to, const struct mon_frame *f)
{
    if (f->good)
        (mon.protocol == MON_HDLC ? hdlc_details : modbus_details)(to, f);
}
