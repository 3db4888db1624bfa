/* A master's line of the kind "sim:" (sim/master_line.h): the line with its station, and what it shows. */
#ifndef FIELDLING_DP_SIM_H
#define FIELDLING_DP_SIM_H

#include "hal_virtual.h"
#include "sim/master.h"

struct dp_sim {
    uint8_t address, baud; /* of the station; enum phy_baud */
    uint8_t out[4];        /* its output modules, as its board got them */
};
extern struct dp_sim dp_sim;

extern const struct ml_view dp_sim_view;

/* A telegram began at `start`; the segment has judged it (seg_said, if it is the station's answer). */
void dp_sim_telegram(bool answer, hv_time start, const uint8_t *octets, unsigned n);

#endif
