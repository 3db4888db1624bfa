#include "hdlc/hdlc_cmd.h"

struct row {
    uint8_t mask, value, kind;
    bool info, nr;
};

/* mask leaves out P/F and the numbers. */
static const CODE struct row rows[] = {
    /*   control             kind       info   N(R) */
    {0x01, HDLC_C_I,    HDLC_I,    true,  true},
    {0x0F, HDLC_C_RR,   HDLC_RR,   false, true},
    {0x0F, HDLC_C_RNR,  HDLC_RNR,  false, true},
    {0x0F, HDLC_C_REJ,  HDLC_REJ,  false, true},
    {0xEF, HDLC_C_UI,   HDLC_UI,   true,  false},
    {0xEF, HDLC_C_SNRM, HDLC_SNRM, false, false},
    {0xEF, HDLC_C_DISC, HDLC_DISC, false, false},
    {0xEF, HDLC_C_TEST, HDLC_TEST, true,  false},
    {0xEF, HDLC_C_XID,  HDLC_XID,  true,  false},
};
#define ROWS (sizeof rows / sizeof rows[0])

uint8_t hdlc_kind(uint8_t control)
{
    uint8_t i;
    for (i = 0; i < ROWS; i++)
        if ((control & rows[i].mask) == rows[i].value)
            return rows[i].kind;
    return HDLC_UNDEFINED;
}

/* The rows stand in the order of enum hdlc_kind. */
bool hdlc_may_carry_info(uint8_t kind)
{
    return kind >= ROWS || rows[kind].info;
}

bool hdlc_has_nr(uint8_t kind)
{
    return kind < ROWS && rows[kind].nr;
}
