/* What of HDLC is built: -DHDLC_CONFIG='"rm_di.h"' names the application's header; every value has a default, and
 * every range is checked here.
 */
#ifndef FIELDLING_HDLC_CONFIG_H
#define FIELDLING_HDLC_CONFIG_H

#include "check.h"

#ifdef HDLC_CONFIG
#include HDLC_CONFIG
#endif

/* Longest information field [octets] that is accepted and sent; one more is answered FRMR. */
#ifndef HDLC_INFO_MAX
#define HDLC_INFO_MAX 64
#endif
/* Without a frame to us for so long [ms] a connected station disconnects itself. our choice: 10 s. */
#ifndef HDLC_INACTIVE_MS
#define HDLC_INACTIVE_MS 10000u
#endif
/* A frame of ours must be out after so long [ms]; else the chip is set up anew. our choice: twice the longest
 * frame at 2400 bit/s. */
#ifndef HDLC_SEND_MS
#define HDLC_SEND_MS 700u
#endif

#if HDLC_INFO_MAX < 8 || HDLC_INFO_MAX > 240
#error "HDLC_INFO_MAX is 8..240"
#endif
#if HDLC_INACTIVE_MS > 60000u || HDLC_SEND_MS > 60000u
#error "HDLC_INACTIVE_MS and HDLC_SEND_MS are at most 60000: ticks have 16 bits"
#endif

#define HDLC_FRAME_MAX (2u + HDLC_INFO_MAX) /* A C I */

#endif
