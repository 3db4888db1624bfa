#include "ddlm/ddlm_cfg.h"

#define WORDS         0x40u
#define IS_INPUT      0x10u
#define IS_OUTPUT     0x20u
#define SPECIAL_IN    0x40u
#define SPECIAL_OUT   0x80u
#define NO_MANUFACTURER_OCTETS 15u

static uint16_t octets(uint8_t coded, uint8_t length_mask)
{
    uint16_t n = (uint16_t)((coded & length_mask) + 1u);

    return (coded & WORDS) ? (uint16_t)(n << 1) : n;
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

bool ddlm_cfg_lengths(const uint8_t XDATA *cfg, uint8_t len, struct ddlm_cfg_lengths XDATA *to)
{
    uint8_t id;

    to->input = 0;
    to->output = 0;
    while (len) {
        id = *cfg++;
        len--;
        if (id & (IS_INPUT | IS_OUTPUT)) {
            if (id & IS_INPUT)
                to->input = (uint16_t)(to->input + octets(id, 0x0F));
            if (id & IS_OUTPUT)
                to->output = (uint16_t)(to->output + octets(id, 0x0F));
            continue;
        }
        if (special_length(id) > len)
            return false;
        if (id & SPECIAL_OUT)
            to->output = (uint16_t)(to->output + octets(cfg[0], 0x3F));
        if (id & SPECIAL_IN)
            to->input = (uint16_t)(to->input + octets(cfg[(id & SPECIAL_OUT) ? 1 : 0], 0x3F));
        cfg += special_length(id);
        len = (uint8_t)(len - special_length(id));
    }
    return true;
}
