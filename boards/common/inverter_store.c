/* Parameters in non-volatile memory: mark, the saved ones high octet first, sum. Written one octet a pass,
 * because an octet of EEPROM takes milliseconds and the server must go on; the mark is written last. */
#include "bytes.h"
#include "hal/hal.h"
#include "inverter_model.h"

#define MARK 0xA5u
#define IDLE 0xFFu

#define SAVED(name, unit, min, max, value, saved, text) +(saved)
#define OCTETS                                          (2u * (0 INV_PARAMS(SAVED)))
STATIC_ASSERT(1 + OCTETS + 1 <= HAL_NV_SIZE, saved_parameters_fit_the_non_volatile_memory);

static uint8_t XDATA image[OCTETS + 2];
static uint8_t XDATA next = IDLE; /* octet of image to be written */

static bool is_saved(uint8_t i)
{
#define IS_SAVED(name, unit, min, max, value, saved, text) saved,
    static const bool CODE saved[] = {INV_PARAMS(IS_SAVED)};
    return saved[i];
}

bool inv_param_ok(uint8_t i, uint16_t value)
{
#define LEAST(name, unit, min, max, value, saved, text) min,
#define MOST(name, unit, min, max, value, saved, text)  max,
    static const uint16_t CODE least[] = {INV_PARAMS(LEAST)};
    static const uint16_t CODE most[] = {INV_PARAMS(MOST)};
    return value >= least[i] && value <= most[i];
}

static uint8_t sum(void)
{
    uint8_t i;
    uint8_t s = MARK;
    for (i = 1; i <= OCTETS; i++)
        s = (uint8_t)(s + image[i]);
    return s;
}

void inv_restore(void)
{
    uint8_t i;
    uint8_t at = 1;
    next = IDLE;
    for (i = 0; i < sizeof image; i++)
        image[i] = hal_nv_read(i);
    if (image[0] != MARK || image[OCTETS + 1u] != sum())
        return;
    for (i = 0; i < INV_P_COUNT; i++) {
        if (!is_saved(i))
            continue;
        if (inv_param_ok(i, get_u16be(image + at)))
            inv_params[i] = get_u16be(image + at);
        at = (uint8_t)(at + 2u);
    }
}

void inv_store(void)
{
    uint8_t i;
    uint8_t at = 1;
    for (i = 0; i < INV_P_COUNT; i++) {
        if (!is_saved(i))
            continue;
        put_u16be(image + at, inv_params[i]);
        at = (uint8_t)(at + 2u);
    }
    image[0] = MARK;
    image[OCTETS + 1u] = sum();
    next = OCTETS + 1u;
    hal_nv_write(0, 0); /* no mark: what is there is not whole from here on */
}

void inv_store_poll(void)
{
    if (next == IDLE)
        return;
    hal_nv_write(next, image[next]);
    next--; /* the mark, octet 0, is the last; then IDLE */
}

bool inv_storing(void)
{
    return next != IDLE;
}
