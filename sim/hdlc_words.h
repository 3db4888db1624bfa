/* Frames in words, for traces; the simulation's own reading of ISO 13239 5.3. */
#ifndef SIM_HDLC_WORDS_H
#define SIM_HDLC_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* "I ns=0 nr=1 pf=1", "RR nr=1 pf=1", "SNRM pf=1", ...; response: the names of responses where they differ. */
const char *hdlc_control_words(uint8_t control, bool response, char *text, size_t size);

#endif
