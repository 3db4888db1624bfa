/* expect: overlaid with others
 * A function that calls nothing, with more temporaries than registers: without --nooverlay SDCC puts them where
 * those of other such functions are, main's among them. */
#include "check.h"

struct reply {
    uint8_t XDATA *room[3];
    uint8_t len[3];
    uint8_t sum[3];
    uint8_t max;
};

void rooms_isr(struct reply XDATA *reply, uint8_t XDATA *rooms, uint8_t max) IN_ISR;

void rooms_isr(struct reply XDATA *reply, uint8_t XDATA *rooms, uint8_t max) IN_ISR
{
    uint8_t i;

    for (i = 0; i < 3; i++) {
        reply->room[i] = rooms;
        reply->len[i] = 0;
        reply->sum[i] = 0;
        rooms += max + 11u;
    }
    reply->max = max;
}
