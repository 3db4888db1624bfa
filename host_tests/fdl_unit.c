#include "fdl_unit.h"

struct unit_ind XDATA ind;
struct unit_isr XDATA isr;
struct fdl_counters XDATA counters;
struct fdl_reply PAGED reply_10;
struct fdl_reply PAGED reply_nil;

static uint8_t XDATA rooms_10[3][FDL_ROOM(16)];
static uint8_t XDATA rooms_nil[3][FDL_ROOM(246)];

void fdl_data_ind(const struct fdl_ind XDATA *what)
{
    uint8_t i;

    ind.count++;
    ind.last = *what;
    for (i = 0; i < what->len && i < sizeof ind.lsdu; i++)
        ind.lsdu[i] = what->lsdu[i];
}

uint8_t fdl_ask_isr(void) IN_ISR
{
    isr.asked++;
    if (isr.reply)
        fdl_req.reply = isr.reply;
    return isr.result;
}

void fdl_ind_isr(void) IN_ISR
{
    isr.count++;
    isr.lsdu = fdl_req.lsdu;
    if (isr.keep)
        isr.kept = fdl_keep_isr(isr.kept);
}

void unit_begin(void)
{
    fake_begin();
    fma_reset(8);
    fma_set_value(FMA_BAUD_RATE, 1);
    ind.count = 0;
    isr.asked = 0;
    isr.count = 0;
    isr.result = FDL_OK;
    isr.keep = false;
    isr.kept = 0;
    isr.reply = 0;
    fdl_reply_init(&reply_10, rooms_10[0], 16, 10);
    fdl_reply_init(&reply_nil, rooms_nil[0], 246, FDL_SAP_NIL);
}

void unit_count(void)
{
    fdl_read_counters(&counters);
}

void unit_srd_sap(uint8_t handling)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_rsap_activate(10, FDL_ALL, 16, handling, &reply_10));
}

void unit_default_sap(uint8_t handling)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_rsap_activate(FDL_SAP_NIL, FDL_ALL, 246, handling, &reply_nil));
}

void unit_update(uint8_t ssap, const char *hex, uint8_t how)
{
    static uint8_t XDATA lsdu[16];

    TEST_ASSERT_EQUAL(FDL_L_OK, fdl_reply_update(ssap, lsdu, from_hex(lsdu, hex), how));
}
