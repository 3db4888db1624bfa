/* A DP master on the segment in virtual time, with line faults between the two. */
#ifndef SIM_BUS_H
#define SIM_BUS_H

#include "sim/dp_master.h"
#include "sim/faults.h"
#include "sim/segment.h"

struct bus_master {
    struct dp_master dp; /* fill address, slaves and hooks; bus_attach() does the rest */
    bool cut;            /* its cable is cut: nothing goes out, nothing comes in */
    /* own */
    struct seg_party party, cable, stranger;
    hv_time next;       /* the poll that is scheduled */
    hv_time deaf_until; /* the request is still on its way, longer than the master thinks */
    unsigned answer_i, answer_hit;
    enum flt answer_fault;
};

/* Put the master on the segment (after seg_begin()) and start it now. Slot time: max_T_SDR + 2 characters. */
void bus_attach(struct bus_master *b);

/* From now on one telegram in `one_in` meets a fault of this kind. FLT_NONE: none. */
void bus_fault(enum flt kind, unsigned one_in, uint64_t seed);
unsigned bus_faults(void); /* how many telegrams were hit */

/* Run virtual time until the question is answered (or lost). -> job->state == DP_JOB_DONE */
bool bus_ask(struct bus_master *b, struct dp_job *job);

#endif
