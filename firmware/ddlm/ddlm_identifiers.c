#include "ddlm/ddlm_cfg.h"

#define WORDS         0x40u
#define IS_INPUT      0x10u
#define IS_OUTPUT     0x20u
#define SPECIAL_IN    0x40u
#define SPECIAL_OUT   0x80u
#define NO_MANUFACTURER_OCTETS 15u

/* 1..128 */
static uint8_t octets(uint8_t coded, uint8_t length_mask)
{
    uint8_t n = (uint8_t)((coded & length_mask) + 1u);

    return (coded & WORDS) ? (uint8_t)(n << 1) : n;
}

static uint8_t special_length(uint8_t id)
{
    uint8_t n = id & 0x0Fu;

    if (n == NO_MANUFACTURER_OCTETS)
        n = 0;
    if (id & SPECIAL_IN)
        n++;
    if (id & SPECIAL_OUT)
        n++;
    return n;
}

/* Where it is: in internal RAM, which halves the code. */
static const uint8_t XDATA *IDATA at;
static IDATA uint16_t input;
static IDATA uint16_t output;

bool ddlm_cfg_lengths(const uint8_t XDATA *cfg, uint8_t len, struct ddlm_cfg_lengths XDATA *to)
{
    uint8_t id;
    uint8_t n;

    at = cfg;
    input = 0;
    output = 0;
    while (len) {
        id = *at++;
        len--;
        if (id & (IS_INPUT | IS_OUTPUT)) {
            n = octets(id, 0x0F);
            if (id & IS_INPUT)
                input = (uint16_t)(input + n);
            if (id & IS_OUTPUT)
                output = (uint16_t)(output + n);
            continue;
        }
        n = special_length(id);
        if (n > len)
            return false;
        len = (uint8_t)(len - n);
        cfg = at;
        at += n;
        if (id & SPECIAL_OUT)
            output = (uint16_t)(output + octets(*cfg++, 0x3F));
        if (id & SPECIAL_IN)
            input = (uint16_t)(input + octets(*cfg, 0x3F));
    }
    to->input = input;
    to->output = output;
    return true;
}
