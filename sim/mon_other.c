/* PROFIBUS-PA and HDLC. A record's line is one frame, as modem and chip deliver them: PA from SDL to CRC, HDLC between its
 * flags with the FCS. */
#include "sim/mon.h"

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
    } unnumbered[] = {{0x03, "UI"},   {0x0F, "DM/SARM"}, {0x43, "DISC/RD"}, {0x63, "UA"},
                      {0x83, "SNRM"}, {0x87, "FRMR"},    {0xAF, "XID"},     {0xE3, "TEST"}};
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
        fprintf(to, o[1] == 0x08 ? "0 -> %02X RM req. %s channel %02X" : "%02X -> 0 RM res. %s channel %02X",
                o[0], o[2] == 1 ? "Request data" : "Control", o[3]);
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
    else if (mon.protocol == MON_HDLC)
        judge_hdlc(f);
    else
        mon_modbus_judge(f);
}

void mon_other_line(FILE *to, const struct mon_frame *f)
{
    (mon.protocol == MON_HDLC ? hdlc_line : mon_modbus_line)(to, f);
}

void mon_other_details(FILE *to, const struct mon_frame *f)
{
    if (f->good)
        (mon.protocol == MON_HDLC ? hdlc_details : mon_modbus_details)(to, f);
}
