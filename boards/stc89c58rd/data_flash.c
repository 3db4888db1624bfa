/* The non-volatile cells of hal.h in the first sector of the data flash, by in-application programming.
 *
 * A log of records in nv_log.h's form: index, value, ~value, ~index; a change costs a record, and the sector is erased only
 * when the log is full. Power lost while a record is written leaves the old value or the new one; while a full log is
 * renewed, cells may be lost. nv_log.c itself would take 22 octets of directly addressed RAM: the DP image has no room.
 *
 * Main only, and no lock: the core stands still while an operation lasts (55 us for an octet, some 20 ms for an erase:
 * data sheet) and goes on where it was. The two writes of the trigger must follow each other.
 */
#include "hal/mcs51/mcs51.h"

#define SECTOR  0x8000u
#define OCTETS  4u   /* of a record */
#define LOG_END 252u /* our choice: half of the sector, octets have 8-bit addresses */
#define ERASED  0xFFu
STATIC_ASSERT(LOG_END / OCTETS > HAL_NV_SIZE, a_renewed_log_has_room);

/* ISP_CONTR: enabled, with the wait states for this clock. */
#if FOSC_HZ >= 40000000
#error "the data flash needs a clock below 40 MHz"
#elif FOSC_HZ >= 20000000
#define ISP_ENABLE 0x80u
#elif FOSC_HZ >= 10000000
#define ISP_ENABLE 0x81u
#else
#define ISP_ENABLE 0x82u
#endif

enum { ISP_IDLE, ISP_READ, ISP_PROGRAM, ISP_ERASE };

/* One operation on octet `at` of the sector -> what was read. Afterwards nothing can be triggered by mistake. */
static uint8_t isp(uint8_t command, uint8_t at)
{
    static __bit on;

    ISP_CONTR = ISP_ENABLE;
    ISP_CMD = command;
    ISP_ADDRH = SECTOR >> 8;
    ISP_ADDRL = at;
    on = EA;
    EA = 0;
    ISP_TRIG = 0x46;
    ISP_TRIG = 0xB9;
    EA = on;
    ISP_CONTR = 0;
    ISP_CMD = ISP_IDLE;
    return ISP_DATA;
}

static uint8_t read(uint8_t at)
{
    return isp(ISP_READ, at);
}

static void program(uint8_t at, uint8_t octet)
{
    ISP_DATA = octet;
    isp(ISP_PROGRAM, at);
}

/* Where the next record goes. Sought from above: an erase that lost power may have left gaps. */
static uint8_t log_end(void)
{
    uint8_t at = LOG_END;

    while (at && read((uint8_t)(at - 1u)) == ERASED && read((uint8_t)(at - OCTETS)) == ERASED)
        at = (uint8_t)(at - OCTETS);
    return at;
}

static bool is_record(uint8_t at, uint8_t index)
{
    return read(at) == index && read((uint8_t)(at + 3u)) == (uint8_t)~index &&
           read((uint8_t)(at + 2u)) == (uint8_t)~read((uint8_t)(at + 1u));
}

uint8_t hal_nv_read(uint8_t index)
{
    uint8_t at = log_end();

    ASSERT(index < HAL_NV_SIZE);
    while (at) {
        at = (uint8_t)(at - OCTETS);
        if (is_record(at, index))
            return read((uint8_t)(at + 1u));
    }
    return ERASED;
}

static void append(uint8_t index, uint8_t value)
{
    uint8_t at = log_end();

    program(at, index);
    program((uint8_t)(at + 1u), value);
    program((uint8_t)(at + 2u), (uint8_t)~value);
    program((uint8_t)(at + 3u), (uint8_t)~index);
}

/* The log is full: keep what the cells hold, and begin anew. */
static void renew(void)
{
    static uint8_t cells[HAL_NV_SIZE];
    uint8_t i;

    for (i = 0; i < HAL_NV_SIZE; i++)
        cells[i] = hal_nv_read(i);
    isp(ISP_ERASE, 0);
    for (i = 0; i < HAL_NV_SIZE; i++)
        if (cells[i] != ERASED)
            append(i, cells[i]);
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    ASSERT(index < HAL_NV_SIZE);
    if (hal_nv_read(index) == value)
        return true;
    if (log_end() == LOG_END)
        renew();
    append(index, value);
    return hal_nv_read(index) == value;
}
