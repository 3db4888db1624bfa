/* The inverter as the Modbus server sees it: its blocks, what it refuses, who it is. */
#include "inverter_modbus.h"
#include "inverter_model.h"

const struct mb_block CODE inv_blocks[] = {
    {MB_COILS, 0, INV_COIL_COUNT, &inv_coils},
    {MB_INPUTS, 0, INV_IN_COUNT, &inv_inputs},
    {MB_HOLDING, 0, INV_P_COUNT, inv_params},
    {MB_INPUT_REGS, 0, INV_V_COUNT, inv_values},
    {MB_FIFO, INV_TRIP_FIFO, 1 + INV_TRIPS_KEPT, inv_trips},
    {MB_FILE, INV_FILE_TREND, INV_TREND_KEPT, NULL},
    {MB_FILE, INV_FILE_NOTE, INV_NOTE_RECORDS, inv_note},
    MB_MAP_END,
};

const struct mb_object CODE mb_objects[] = {
    {0, "Fieldling"},          {1, "INV-1"}, {2, "V0.1"}, {4, "Fieldling inverter"},
    {5, "Simulated AC drive"}, {0, NULL},
};

/* The value that parameter i has after the write of mb_span. */
static uint16_t after(uint8_t i)
{
    if (i >= mb_span.addr && i - mb_span.addr < mb_span.qty)
        return mb_span_get(i - mb_span.addr);
    return inv_params[i];
}

static bool changes(uint8_t i)
{
    return after(i) != inv_params[i];
}

/* Our choice: 04 for RUN while tripped (the device cannot), 03 for values out of range or against each other,
 * 06 for what must not change while the motor turns and while parameters are being stored, 05 for the store
 * itself. */
static uint8_t check_params(void)
{
    uint8_t i;
    for (i = 0; i < INV_P_COUNT; i++)
        if (!inv_param_ok(i, after(i)))
            return MB_ILLEGAL_VALUE;
    if (after(INV_P_MIN_FREQ) > after(INV_P_MAX_FREQ))
        return MB_ILLEGAL_VALUE;
    if (inv_values[INV_V_OUTPUT_FREQ] &&
        (changes(INV_P_BASE_FREQ) || changes(INV_P_RATED_VOLTAGE) || changes(INV_P_RATED_CURRENT)))
        return MB_BUSY;
    if (after(INV_P_STORE) == 0)
        return MB_OK;
    if (mb_span.qty != 1)
        return MB_ILLEGAL_VALUE; /* the command stands alone */
    inv_store();
    return MB_ACKNOWLEDGE;
}

static uint8_t check_coils(void)
{
    const uint16_t run = INV_COIL_RUN - mb_span.addr; /* RUN is coil 0 */
    if (mb_span.addr == INV_COIL_RUN && mb_span_get(run) && inv_values[INV_V_TRIP_CODE] != INV_NO_TRIP)
        return MB_DEVICE_FAILURE;
    return MB_OK;
}

uint8_t inv_check(void)
{
    if (!mb_span.write)
        return MB_OK;
    if (inv_storing())
        return MB_BUSY;
    if (mb_span.table == MB_HOLDING)
        return check_params();
    if (mb_span.table == MB_COILS)
        return check_coils();
    return mb_span.file == INV_FILE_NOTE ? MB_OK : MB_DEVICE_FAILURE; /* the trend cannot be written */
}

/* The trend is the one block without data. */
uint8_t inv_block(void)
{
    uint8_t i;
    for (i = 0; i < mb_span.qty; i++)
        mb_span_put(i, inv_trend((uint8_t)(mb_span.addr + i)));
    return MB_OK;
}

/* Our choice: server id 'I', run indicator, then the name. */
uint8_t inv_server_id(uint8_t XDATA *octets)
{
    static const char CODE name[] = "Fieldling inverter";
    uint8_t i;
    octets[0] = 'I';
    octets[1] = inv_values[INV_V_OUTPUT_FREQ] ? 0xFF : 0;
    for (i = 0; name[i]; i++)
        octets[2u + i] = (uint8_t)name[i];
    return (uint8_t)(2u + i);
}
