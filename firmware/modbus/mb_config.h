/* What is built: -DMB_CONFIG='"inverter_mb.h"'. Here the application's header is completed and checked; no
 * other file reads it.
 *
 * The header must define the table of functions and may define the rest:
 *   MB_FUNCTIONS(ROW)  one ROW(code, handler, octets, how) a function. Leave a row out and the function,
 *                      with all that only it needs, is not in the image. mb_all_functions.h has every row.
 *       code     1..127
 *       handler  uint8_t handler(void), mb.h
 *       octets   of the request, function code included: the server checks the length before the handler runs
 *       how      MB_EXACT    just as many
 *                MB_COUNTED  as many, the last of them says how many more follow
 *                MB_LEAST    at least as many
 *                | MB_BROADCAST  executed when sent to address 0
 *   MB_WITH_ASCII      1: RTU or ASCII, chosen at run time; 0: RTU only. Default 1
 *   MB_WITH_LUMPS      1: with mb_port.gap_tbit set, a good frame of another station ends with its CRC; for
 *                      ptys and USB adapters with several stations. Default 0
 *   MB_LOCK() MB_UNLOCK(state)  values in memory are copied between these two, so that an interrupt of the
 *                      application never sees half a value and never leaves one. Default: interrupts masked
 *                      (hal.h). Where the tables are used in main only: 0 and (void)(state)
 *
 * The table of the CRC is chosen for the whole image: -DCRC16_ENTRIES=16, 256 or 512, crc16.h.
 */
#ifndef FIELDLING_MB_CONFIG_H
#define FIELDLING_MB_CONFIG_H

#include "check.h"
#include MB_CONFIG

#ifndef MB_WITH_ASCII
#define MB_WITH_ASCII 1
#endif

#ifndef MB_WITH_LUMPS
#define MB_WITH_LUMPS 0
#endif
#ifndef MB_LOCK
#define MB_LOCK()        hal_irq_save()
#define MB_UNLOCK(state) hal_irq_restore(state)
#endif

#define MB_EXACT     0u
#define MB_COUNTED   1u
#define MB_LEAST     2u
#define MB_BROADCAST 0x80u

/* What the rows need, worked out from their codes: plain constants for plain `if`s. */
#define MB_IS_LOG(code, handler, octets, how)         || (code) == 12
#define MB_IS_DIAGNOSTICS(code, handler, octets, how) || (code) == 8 || (code) == 11 || (code) == 12
#define MB_IS_FILE(code, handler, octets, how)        || (code) == 20 || (code) == 21
#define MB_IS_FILE_READ(code, handler, octets, how)   || (code) == 20
#define MB_IS_BAD(code, handler, octets, how)                                                                \
    || !((code) >= 1 && (code) <= 127 && (octets) >= 1 && (octets) <= 253)
enum {
    MB_HAS_LOG = (0 MB_FUNCTIONS(MB_IS_LOG)),
    MB_HAS_DIAGNOSTICS = (0 MB_FUNCTIONS(MB_IS_DIAGNOSTICS)),
    MB_HAS_FILES = (0 MB_FUNCTIONS(MB_IS_FILE)),
    MB_HAS_FILE_READ = (0 MB_FUNCTIONS(MB_IS_FILE_READ)),
};
STATIC_ASSERT(!(0 MB_FUNCTIONS(MB_IS_BAD)), function_codes_are_1_to_127_and_requests_1_to_253_octets);

/* Address, PDU, CRC: [S] 2.5.1. In ASCII the answer is spelt out in the same buffer: [S] 2.5.2. Function 20
 * needs its request while the answer grows. */
#define MB_PDU_MAX    253u
#define MB_RTU_MAX    256u
#define MB_ASCII_MAX  513u
#define MB_ADU_OCTETS (MB_WITH_ASCII ? MB_ASCII_MAX : MB_HAS_FILE_READ ? 2 * MB_RTU_MAX : MB_RTU_MAX)

#endif
