/* A DP station on the segment in virtual time, and a tester who writes telegrams octet by octet.
 *
 * Station 8 at 19200 bit/s by default; the tester is whoever the telegrams say (2 is the usual master).
 */
#ifndef DP_FIXTURE_H
#define DP_FIXTURE_H

#include "ddlm/ddlm.h"
#include "phy_uart/phy_uart.h"
#include "sim/bus.h"
#include "sim/random.h"
#include "unity.h"

/* What the application puts in and got out. */
extern uint8_t dp_in[244], dp_out[244];
extern unsigned dp_outs;    /* how often the application was given outputs */
extern unsigned dp_reports; /* ddlm_fault_ind() */

/* The device: dp_station_test01.c (DP-TEST01 with its own application) or dp_station_any.c (inputs and
 * outputs of any configuration header, straight from and to dp_in and dp_out). */
void dp_station_init(uint8_t switches, uint8_t baud);
void dp_station_poll(void);

/* Start: virtual time from 0, segment at 19200, station at address `switches` (126: from NV), baud an enum
 * phy_baud or DDLM_BAUD_AUTO, main loop every 100 us. */
void dp_begin(uint8_t switches, uint8_t baud);
void dp_begin_at(uint8_t switches, uint8_t baud, uint32_t bit_per_s);

/* Power off and on again: same memory of the non-volatile kind, nothing else. */
void dp_power_cycle(void);

/* Send a telegram T_SYN after whatever was last; -> the station's answer in hex, "" for silence. Marks in the
 * text: 10!  this octet comes with a parity error     10~  with a framing error _40  idle of 40 T_bit before
 * the next octet The main loop runs for 1 ms afterwards. The judge must be content. */
const char *dp_ask(const char *hex, unsigned line);

/* The answer to a telegram, exactly; or silence. */
#define ASK(request, expected)                                                                               \
    UNITY_TEST_ASSERT_EQUAL_STRING((expected), dp_ask((request), __LINE__), __LINE__, (request))
#define SILENT(request) ASK(request, "")

/* The same with octets; -> number of octets of the answer, in seg_said. */
unsigned dp_ask_octets(const uint8_t *octets, unsigned n, unsigned line);

/* Slave_Diag octets 1 and 2 as master 2 reads them, high octet first; 0xFFFF: no answer. */
#define DIAG(expected)                                                                                       \
    UNITY_TEST_ASSERT_EQUAL_HEX16((expected), dp_diag(__LINE__), __LINE__, "Slave_Diag octets 1, 2")
unsigned dp_diag(unsigned line);

/* Literal telegrams of master 2 for station 8, DP-TEST01 (ident 1234H, cfg 10 20 10 20); FC 6D: each is a
 * first one. */
#define GET_DIAG   "68 05 05 68 88 82 6D 3C 3E F1 16"
#define SET_PRM    "68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 BB 16" /* lock, no watchdog, group 1 */
#define SET_PRM_SF "68 0C 0C 68 88 82 6D 3D 3E B0 01 01 00 12 34 01 EB 16" /* and Sync, Freeze allowed */
#define SET_PRM_WD "68 0C 0C 68 88 82 6D 3D 3E 88 01 05 00 12 34 01 C7 16" /* and watchdog 1 x 5 x 10 ms */
#define CHK_CFG    "68 09 09 68 88 82 6D 3E 3E 10 20 10 20 53 16"
#define ACK        "E5"
/* Data_Exchange with outputs 11 22; its answer with inputs 1E 00 */
#define DX         "68 05 05 68 08 02 6D 11 22 AA 16"
#define DX_OK      "68 05 05 68 02 08 08 1E 00 30 16"

/* Set_Prm (one of the above) and Chk_Cfg, then until ready. */
#define TO_DATA_EXCH(set_prm) dp_to_data_exch((set_prm), __LINE__)
void dp_to_data_exch(const char *set_prm, unsigned line);

#define STATE(expected) UNITY_TEST_ASSERT_EQUAL_UINT((expected), dp_info()->state, __LINE__, "state")
const struct ddlm_info *dp_info(void);
#define OUTPUTS(a, b)                                                                                        \
    do {                                                                                                     \
        TEST_ASSERT_EQUAL_HEX8((a), dp_out[0]);                                                              \
        TEST_ASSERT_EQUAL_HEX8((b), dp_out[1]);                                                              \
    } while (0)

/* n in quick runs, full when TEST_FULL is set. */
unsigned dp_count(unsigned quick, unsigned full);

extern struct seg_party dp_tester;

/* dp_station_any.c only: take every configuration. */
extern bool dp_adapts;

#endif
