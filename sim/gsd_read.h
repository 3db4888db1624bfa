/* What a master needs of a GSD file: ident, modules, user parameters, rates. A file that a checker accepts
 * (gsd/check) is read whole; unknown keywords are skipped.
 *
 * Source: facts, section 5.
 */
#ifndef SIM_GSD_READ_H
#define SIM_GSD_READ_H

#include <stdbool.h>
#include <stdint.h>

#define GSD_MODULES 64
#define GSD_OCTETS  64

struct gsd_module {
    char name[64];
    uint8_t cfg[GSD_OCTETS], cfg_n;
    bool preset;
};

struct gsd {
    char vendor[40], model[40];
    uint16_t ident;
    bool modular, sync, freeze, fail_safe;
    unsigned max_module, min_slave_interval; /* [100 us] */
    uint8_t user_prm[GSD_OCTETS], user_prm_n;
    unsigned modules_n;
    struct gsd_module modules[GSD_MODULES];
};

/* -> NULL, or what is wrong, for a person; *line is where, 0 for the file as such. */
const char *gsd_read(const char *path, struct gsd *to, unsigned *line);

/* The module of that name, NULL when there is none. */
const struct gsd_module *gsd_module(const struct gsd *g, const char *name);

#endif
