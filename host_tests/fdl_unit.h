/* Station 8 of the FDL module tests: the whole data link over PHY, and a layer above that writes down what it is told. */
#ifndef FDL_UNIT_H
#define FDL_UNIT_H

#include "fake_hal.h"
#include "fdl/fma.h"

/* Indications that came through fdl_data_ind(); the last one in full. */
struct unit_ind {
    uint8_t count;
    struct fdl_ind last;
    uint8_t lsdu[8];
};
extern struct unit_ind XDATA ind;

/* What came through fdl_ask_isr(), and what it answers; requests that came through fdl_ind_isr(). */
struct unit_isr {
    uint8_t asked;
    uint8_t count;
    uint8_t result;
    struct fdl_reply PAGED *reply; /* answers in the place of the SAP's, 0: none does */
    bool keep;           /* keeps each L_sdu */
    uint8_t XDATA *kept; /* the buffer of the last one */
    uint8_t XDATA *lsdu;
};
extern struct unit_isr XDATA isr;

extern struct fdl_counters XDATA counters; /* as count() read them */

/* Address 8, 19.2 kbit/s, no SAP active. */
void unit_begin(void);
void unit_count(void);

/* counters.x is n. */
#define COUNTED(n, x)                                                                                           \
    do {                                                                                                        \
        unit_count();                                                                                           \
        TEST_ASSERT_EQUAL_UINT16(n, counters.x);                                                                \
    } while (0)

/* SAP 10 with an update buffer of up to 16 octets; another one on the default SAP. */
extern struct fdl_reply PAGED reply_10;
extern struct fdl_reply PAGED reply_nil;
void unit_srd_sap(uint8_t handling);
void unit_default_sap(uint8_t handling);

/* Update the buffer of SAP 10, of the default SAP. */
void unit_update(uint8_t ssap, const char *hex, uint8_t how);

#endif
