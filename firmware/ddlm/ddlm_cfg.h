/* Identifier bytes of Chk_Cfg and Get_Cfg.
 *
 *   compact   bit 7 consistency over the whole, 6 words, 5..4 01 input 10 output 11 both, 3..0 length - 1
 *   special   bits 5..4 = 00; 7..6 00 empty slot, 01 an input length octet follows, 10 output, 11 output then input;
 *             3..0 manufacturer octets behind them, 0..14; 15 = none
 *   length octet   bit 7 consistency, 6 words, 5..0 length - 1
 * Source   EN 50170-2 part 8, Chk_Cfg; facts 3.8
 */
#ifndef FIELDLING_DDLM_CFG_H
#define FIELDLING_DDLM_CFG_H

#include "check.h"

/* Sums of a configuration [octets], as the master sees them: input = slave to master. */
struct ddlm_cfg_lengths {
    uint16_t input;
    uint16_t output;
};

/* Read cfg[0..len-1]; false where the last identifier is cut off. main. */
bool ddlm_cfg_lengths(const uint8_t XDATA *cfg, uint8_t len, struct ddlm_cfg_lengths XDATA *to);

#endif
