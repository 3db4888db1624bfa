/* What a PROFIBUS-DP telegram means, in words, for traces. */
#ifndef FIELDLING_DP_WORDS_H
#define FIELDLING_DP_WORDS_H

#include "sim/telegram.h"

#include <stddef.h>

/* The FDL layer of a good telegram, as key=value pairs: "fdl=SRD_HIGH da=3.61 sa=2.62 fcb=1 fcv=0 len=7". */
void dp_fdl_words(const struct tg *t, char *text, size_t size);

/* The DDLM service, "Set_Prm.req", "Slave_Diag.res", or "none" for what FDL deals with alone. asked: FC of the request
 * before, without which the answer to an Ident request looks like that to a Data_Exchange. */
const char *dp_service(const struct tg *t, uint8_t asked);

/* enum ddlm_state, enum ddlm_wd_state in words. */
const char *dp_state_word(uint8_t state);
const char *dp_wd_state_word(uint8_t wd_state);

#endif
