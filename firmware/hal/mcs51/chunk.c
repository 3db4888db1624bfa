/* Octets by the chunk to phy_uart: what line_octet_isr() does with an octet of a chunk, without the call.
 *
 * In burst the interrupt stays until nobody wants an octet any more or the line has fallen silent.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"
#include "phy_uart/phy_uart.h"

static void store_isr(void) __using(2)
{
    if (octet_err || phy_rx.waiting || phy_rx.left == 0) {
        line_octet_isr(octet, octet_err);
        return;
    }
    *phy_rx.at = octet;
    phy_rx.at++;
    phy_rx.sum += octet;
    if (--phy_rx.left == 0)
        phy_chunk_ind_isr();
}

void take_isr(void) __using(2)
{
    for (;;) {
        store_isr();
        if (!burst || held_any || phy_rx.left == 0)
            break;
        while (!RI)
            if (TF0)
                return;
        receive_isr();
    }
    look_isr();
}

void look_isr(void) __using(2)
{
    deaf = phy_rx.left == 0 && !phy_rx.waiting && !sending;
}
