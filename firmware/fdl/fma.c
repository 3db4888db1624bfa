/* Variables and SAPs: every value is held by the layer it belongs to, this is the one door to them. */
#include "fdl/fma.h"
#include "fdl/fdl_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

#define T_SL_DEFAULT_TBIT 100u /* EN 50170-2 part 8: up to 187.5 kbit/s */
#define T_SL_MIN_TBIT     37u
#define T_SL_MAX_TBIT     16383u
#define T_SDR_MIN_TBIT    11u
#define T_SDR_MAX_TBIT    255u

static uint16_t t_sl;

uint8_t fma_reset(uint8_t ts)
{
    if (ts > FDL_UNADDRESSED)
        return FMA_IV;
    phy_reset();
    fdl_reset(ts);
    t_sl = T_SL_DEFAULT_TBIT;
    fma_watch_reset();
    fma_watch_t_sl(t_sl);
    return FMA_OK;
}

/* PHY variable behind an FMA variable, PHY_VARIABLES where there is none. */
static uint8_t phy_variable_of(uint8_t variable)
{
    switch (variable) {
    case FMA_BAUD_RATE:
        return PHY_BAUD_RATE;
    case FMA_MEDIUM_RED:
        return PHY_MEDIUM_RED;
    case FMA_TRANSMITTER:
        return PHY_TRANSMITTER_OUTPUT;
    case FMA_SIGNAL_SOURCE:
        return PHY_RECEIVED_SIGNAL_SOURCE;
    case FMA_LOOP:
        return PHY_LOOP;
    default:
        return PHY_VARIABLES;
    }
}

static uint8_t set_phy(uint8_t variable, uint16_t value)
{
    if (value > 0xFFu)
        return FMA_IV;
    switch (phy_set_value(variable, (uint8_t)value)) {
    case PHY_OK:
        fma_watch_t_sl(t_sl);
        return FMA_OK;
    case PHY_NO:
        return FMA_NO;
    default:
        return FMA_IV;
    }
}

static uint8_t set_t_sl(uint16_t value)
{
    if (value < T_SL_MIN_TBIT || value > T_SL_MAX_TBIT)
        return FMA_IV;
    t_sl = value;
    fma_watch_t_sl(t_sl);
    return FMA_OK;
}

static uint8_t set_min_t_sdr(uint16_t value)
{
    if (value < T_SDR_MIN_TBIT || value > T_SDR_MAX_TBIT)
        return FMA_IV;
    phy_set_min_t_sdr((uint8_t)value);
    return FMA_OK;
}

static uint8_t clear_count(uint16_t XDATA *count, uint16_t value)
{
    uint8_t irq;

    if (value != 0)
        return FMA_IV;
    irq = hal_irq_save();
    *count = 0;
    hal_irq_restore(irq);
    fma_watch_cleared(count);
    return FMA_OK;
}

uint8_t fma_set_value(uint8_t variable, uint16_t value)
{
    if (phy_variable_of(variable) != PHY_VARIABLES)
        return set_phy(phy_variable_of(variable), value);
    switch (variable) {
    case FMA_TS:
        if (value > FDL_UNADDRESSED)
            return FMA_IV;
        fdl_set_address((uint8_t)value);
        return FMA_OK;
    case FMA_T_SL:
        return set_t_sl(value);
    case FMA_MIN_T_SDR:
        return set_min_t_sdr(value);
    case FMA_SD_COUNT:
        return clear_count(&fdl_counters.sd_count, value);
    case FMA_SD_ERROR_COUNT:
        return clear_count(&fdl_counters.sd_error_count, value);
    default:
        return FMA_IV;
    }
}

uint16_t fma_count(const uint16_t XDATA *count)
{
    uint8_t irq = hal_irq_save();
    uint16_t value = *count;

    hal_irq_restore(irq);
    return value;
}

uint8_t fma_read_value(uint8_t variable, uint16_t XDATA *value)
{
    uint16_t now;

    switch (variable) {
    case FMA_TS:
        now = fdl_ts;
        break;
    case FMA_T_SL:
        now = t_sl;
        break;
    case FMA_MIN_T_SDR:
        now = phy_min_t_sdr();
        break;
    case FMA_SD_COUNT:
        now = fma_count(&fdl_counters.sd_count);
        break;
    case FMA_SD_ERROR_COUNT:
        now = fma_count(&fdl_counters.sd_error_count);
        break;
    default:
        variable = phy_variable_of(variable);
        if (variable == PHY_VARIABLES)
            return FMA_IV;
        now = phy_read_value(variable);
        break;
    }
    *value = now;
    return FMA_OK;
}

static uint8_t ident_len;
static uint8_t ident_strings;

static void put_string(uint8_t XDATA *to, const char CODE *text)
{
    uint8_t start = ident_len;

    while (*text)
        to[ident_len++] = (uint8_t)*text++;
    to[ident_strings++] = (uint8_t)(ident_len - start);
}

STATIC_ASSERT(sizeof DEV_VENDOR + sizeof DEV_MODEL + sizeof DEV_HW_RELEASE + sizeof DEV_SW_RELEASE <= 64,
              ident_strings_fit_64_octets);

uint8_t fma_ident(uint8_t XDATA *to)
{
    static const char CODE vendor[] = DEV_VENDOR;
    static const char CODE model[] = DEV_MODEL;
    static const char CODE hw_release[] = DEV_HW_RELEASE;
    static const char CODE sw_release[] = DEV_SW_RELEASE;

    ident_len = 4;
    ident_strings = 0;
    put_string(to, vendor);
    put_string(to, model);
    put_string(to, hw_release);
    put_string(to, sw_release);
    return ident_len;
}

uint8_t fma_lsap_status(uint8_t sap, struct fdl_sap PAGED *to)
{
    struct fdl_sap PAGED *row;
    uint8_t irq;

    if (sap >= FDL_SAP_NUMBERS)
        return FMA_IV;
    irq = hal_irq_save();
    row = fdl_sap_row_isr(sap);
    hal_irq_restore(irq);
    if (!row->services)
        return FMA_LS;
    *to = *row;
    return FMA_OK;
}

static struct fdl_sap PAGED new_row;

static uint8_t activate(uint8_t sap)
{
    if (sap >= FDL_SAP_NUMBERS || sap == FDL_SAP_MAX + 1u || new_row.access > FDL_ALL ||
        new_row.handling > FDL_TO_MAIN)
        return FMA_IV;
    return fdl_sap_set(sap, &new_row) ? FMA_OK : FMA_LR;
}

uint8_t fma_sap_activate(uint8_t sap, uint8_t access, uint8_t services, uint8_t max_len, uint8_t handling)
{
    if (services == 0 || (services & ~(FDL_SDA | FDL_SDN)))
        return FMA_IV;
    new_row.access = access;
    new_row.services = services;
    new_row.max_len = max_len;
    new_row.handling = handling;
    new_row.reply = 0;
    return activate(sap);
}

uint8_t fma_rsap_activate(uint8_t sap, uint8_t access, uint8_t max_len, uint8_t handling,
                          struct fdl_reply PAGED *reply)
{
    new_row.access = access;
    new_row.services = FDL_SRD;
    new_row.max_len = max_len;
    new_row.handling = handling;
    new_row.reply = reply;
    return activate(sap);
}

uint8_t fma_sap_deactivate(uint8_t sap)
{
    if (sap >= FDL_SAP_NUMBERS)
        return FMA_IV;
    return fdl_sap_clear(sap) ? FMA_OK : FMA_LS;
}

void phy_event_ind(uint8_t variable, uint8_t value)
{
    (void)value;
    fma_event_ind(FMA_EVENT_PHY, variable);
}
