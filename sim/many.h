/* Many stations on one segment in one process and in virtual time.
 *
 * An image holds one station, in file-static state (DESIGN.md). So the station with its port in virtual time is built as
 * a shared object, and each station is a copy of its own of that file: same code, own state. This is what a copy
 * shows; boards/posix/dp_many.c fills it in. Times are 1/576 us, as everywhere in virtual time.
 */
#ifndef SIM_MANY_H
#define SIM_MANY_H

#include <stdint.h>

#define MANY_SYMBOL "fieldling_many_station"

struct many_station {
    /* Power up with these address switches and that Baud_rate code; says() is called for each octet it sends, with the
     * time of its start bit and of the end of its stop bit. */
    void (*power_on)(uint8_t address, uint8_t baud,
                     void (*says)(void *of, uint8_t octet, uint64_t start, uint64_t end), void *of);
    /* An octet will have arrived at time t, not before the station's now. */
    void (*hears)(uint64_t t, uint8_t octet);
    /* Let the station live until t. */
    void (*run_until)(uint64_t t);
    /* Its DDLM state (3: DATA_EXCH), executed exchanges (they wrap), telegrams for others it has heard (likewise). */
    void (*look)(uint8_t *state, uint16_t *exchanges, uint16_t *foreign);
    /* Bit time of a Baud_rate code, 0: none; max_T_SDR in bit times. */
    uint64_t (*bit)(uint8_t baud);
    unsigned (*max_t_sdr)(uint8_t baud);
};

#endif
