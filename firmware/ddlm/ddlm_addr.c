/* Set_Slave_Add: the master gives the station its address.
 *
 *   octet 1 New_Slave_Add   2, 3 Ident_Number   4 No_Add_Chg   5... Rem_Slave_Data (not used)
 *
 * Taken only without an owner (POWER_ON at address 126, WAIT_PRM), with the right ident, and while changes are
 * allowed; otherwise acknowledged and not processed. our choice: the new address is valid at once, as in most
 * ASICs.
 * Source   EN 50170-2 part 8, Set_Slave_Add; spec A6; facts 3.12
 */
#include "bytes.h"
#include "ddlm/ddlm_priv.h"
#include "hal/hal.h"

/* Non-volatile cells. The complement tells a stored address from erased or half-written memory. */
#define NV_ADDRESS    0u
#define NV_COMPLEMENT 1u
#define NV_LOCK       2u
#define LOCKED        0x5Au
#define ERASED        0xFFu

#define ADDRESS_MAX 125u
#define REQUEST_MIN 4u

uint8_t ddlm_stored_address(void)
{
    uint8_t address = hal_nv_read(NV_ADDRESS);

    if (address > ADDRESS_MAX || (address ^ hal_nv_read(NV_COMPLEMENT)) != 0xFFu)
        return FDL_UNADDRESSED;
    return address;
}

bool ddlm_stored_lock(void)
{
    return ddlm_stored_address() != FDL_UNADDRESSED && hal_nv_read(NV_LOCK) == LOCKED;
}

bool ddlm_factory_reset(void)
{
    return hal_nv_write(NV_COMPLEMENT, ERASED) && hal_nv_write(NV_ADDRESS, ERASED) && hal_nv_write(NV_LOCK, ERASED);
}

/* The complement is written last: power may fail in between, and then there is no address rather than a wrong one. */
static bool store(uint8_t address, bool lock)
{
    return hal_nv_write(NV_COMPLEMENT, ERASED) && hal_nv_write(NV_LOCK, lock ? LOCKED : ERASED) &&
           hal_nv_write(NV_ADDRESS, address) && hal_nv_write(NV_COMPLEMENT, (uint8_t)~address);
}

void ddlm_set_slave_add_ind(const struct fdl_ind XDATA *ind)
{
    const uint8_t XDATA *request = ind->lsdu;
    bool lock;

    if (ddlm.state > DDLM_WAIT_PRM || ddlm.locked || ind->len < REQUEST_MIN || request[0] > ADDRESS_MAX ||
        get_u16be(request + 1) != DEV_IDENT) {
        ddlm_counters.not_processed++;
        return;
    }
    lock = request[3] != 0;
    if (!store(request[0], lock)) {
        ddlm_fault_ind(DDLM_NO);
        return;
    }
    ddlm.address = request[0];
    ddlm.locked = lock;
    ddlm_check_fma(fma_set_value(FMA_TS, ddlm.address));
    ddlm_leave_master();
}
