#include "dp_test01_app.h"
#include "board.h"
#include "ddlm/ddlm.h"

enum module { TEMPERATURE, OUTPUT_1, SENSOR, OUTPUT_2 };

#define LIMIT_DEFAULT 50u /* degrees */

static uint8_t XDATA inputs[DEV_INPUT_LEN];
static uint8_t XDATA outputs[DEV_OUTPUT_LEN];
static bool watch_temperature; /* user parameter octet 1, bit 0 */
static uint8_t limit;          /* user parameter octet 2        */
static bool too_hot;

/*   octet 1  bit 0 diagnose over-temperature, 7..1 must be 0   2  limit, 0 = default   3  must be 0 */
bool ddlm_user_prm_ind(const uint8_t XDATA *prm, uint8_t len)
{
    if ((len > 0 && (prm[0] & 0xFEu)) || (len > 2 && prm[2]))
        return false;
    watch_temperature = len > 0 && (prm[0] & 1u);
    limit = len > 1 && prm[1] ? prm[1] : LIMIT_DEFAULT;
    return true;
}

/* Device related block: length 2, then bit 0 over-temperature. Told when it comes and when it goes. */
static void diagnose(void)
{
    static uint8_t XDATA block[2] = {0x02, 0x01};
    bool hot = watch_temperature && inputs[0] > limit;

    if (hot == too_hot)
        return;
    too_hot = hot;
    ddlm_diag(block, hot ? sizeof block : 0, hot ? DDLM_EXT_DIAG : 0);
}

uint8_t dp_test01_init(uint8_t switches, uint8_t baud)
{
    watch_temperature = false;
    limit = LIMIT_DEFAULT;
    too_hot = false;
    return ddlm_slave_init(switches, baud);
}

void dp_test01_poll(void)
{
    ddlm_poll();
    if (ddlm_outputs(outputs) != DDLM_OUT_SAME) {
        board_output(OUTPUT_1, outputs[0]);
        board_output(OUTPUT_2, outputs[1]);
    }
    inputs[0] = board_input(TEMPERATURE);
    inputs[1] = board_input(SENSOR);
    ddlm_inputs(inputs);
    diagnose();
}
