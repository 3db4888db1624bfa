#include "sim/hdlc_words.h"

#include <stdio.h>

/* U frames without P/F, modulo 8. */
static const struct {
    uint8_t code;
    const char *command, *response;
} unnumbered[] = {
    {0x03, "UI", "UI"},     {0x07, "SIM", "RIM"},   {0x0F, "SARM", "DM"}, {0x23, "UP", "UP"},
    {0x2F, "SABM", "SABM"}, {0x43, "DISC", "RD"},   {0x63, "UA", "UA"},   {0x83, "SNRM", "SNRM"},
    {0x87, "FRMR", "FRMR"}, {0x8F, "RSET", "RSET"}, {0xAF, "XID", "XID"}, {0xCF, "SNRME", "SNRME"},
    {0xE3, "TEST", "TEST"},
};

const char *hdlc_control_words(uint8_t control, bool response, char *text, size_t size)
{
    static const char *const supervisory[] = {"RR", "RNR", "REJ", "SREJ"};
    const unsigned nr = control >> 5, pf = (control >> 4) & 1u;
    const char *name = "U?";

    if ((control & 1u) == 0) {
        snprintf(text, size, "I ns=%u nr=%u pf=%u", (control >> 1) & 7u, nr, pf);
        return text;
    }
    if ((control & 3u) == 1u) {
        snprintf(text, size, "%s nr=%u pf=%u", supervisory[(control >> 2) & 3u], nr, pf);
        return text;
    }
    for (unsigned i = 0; i < sizeof unnumbered / sizeof unnumbered[0]; i++)
        if (unnumbered[i].code == (control & 0xEFu))
            name = response ? unnumbered[i].response : unnumbered[i].command;
    snprintf(text, size, "%s pf=%u", name, pf);
    return text;
}
