/* Who a class 1 master serves: from a small text file, or from GSD files named on the command line.
 *
 *   # a comment
 *   address 2              of the master
 *   rate 500000            bit/s
 *   slave 8                begins a slave; what follows is about it
 *     gsd FLDL1234.GSD     ident, parameters, preset modules; the path is seen from this file
 *     module "Sensor"      instead of the preset modules: these, in this order
 *     ident 0x1234         without a GSD file, or instead of what it says: ident, cfg, prm
 *     cfg 10 20 10 20      identifier bytes, hexadecimal
 *     prm 01 00 00         user parameters, hexadecimal
 *     watchdog 200         [ms], 10 to 650250, rounded up to what two factors can say; off
 *     min-tsdr 11          [T_bit]
 *     group 01             hexadecimal
 *     sync                 ask for Sync; freeze: for Freeze
 *     outputs 01 02        first outputs, hexadecimal
 */
#ifndef SIM_MASTER_SETUP_H
#define SIM_MASTER_SETUP_H

#include "sim/dp_master.h"
#include "sim/gsd_read.h"

#define SETUP_SLAVES 126

struct setup {
    uint8_t address;
    uint32_t rate;
    unsigned slaves_n;
    struct dp_slave slaves[SETUP_SLAVES];
    char model[SETUP_SLAVES][40];
    /* own */
    struct gsd gsd; /* of the slave being described */
    bool has_gsd;
    char wrong[160];
};

/* All of these: NULL, or what is wrong, for a person. */
const char *setup_read(struct setup *s, const char *path);

/* A slave with its GSD file and preset modules; then modules instead, one by one; then setup_end(). */
const char *setup_slave(struct setup *s, const char *address, const char *gsd_path);
const char *setup_module(struct setup *s, const char *name);
const char *setup_end(struct setup *s);

#endif
