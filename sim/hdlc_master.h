/* The primary on the line of hdlc_bus.h, in virtual time, with faults at frames of the test's choice. */
#ifndef SIM_HDLC_MASTER_H
#define SIM_HDLC_MASTER_H

#include "sim/hdlc_bus.h"
#include "sim/hdlc_primary.h"

/* What happens to a frame, with its reason in the field. */
#define HM_FAULTS(F)                                                                                                   \
    F(NONE, "a good line")                                                                                             \
    F(LOST, "a bad contact: the frame does not arrive")                                                                \
    F(BIT, "a spike turns a bit")                                                                                      \
    F(CUT, "the sender is reset: the rest is missing")                                                                 \
    F(SLIP, "the receiver's clock slips: a bit is missing")                                                            \
    F(TWICE, "an echo on a repeater: an answer comes twice (a command: collides with its answer, not tried)")          \
    F(LATE, "a modem that stores: a copy of an answer comes when the next command is already out")

enum hm_fault {
#define HM_NAME(name, reason) HM_##name,
    HM_FAULTS(HM_NAME)
#undef HM_NAME
        HM_KINDS
};
const char *hm_reason(enum hm_fault kind);

struct hm_plan {
    unsigned frame; /* number of the frame on the line since hm_begin(), commands and answers alike */
    enum hm_fault kind;
};

extern struct hp hm_primary;
extern unsigned hm_frames; /* on the line so far */

/* After hbus_begin() and hbus_station(): plan[0..n-1] (kept by the caller) says which frames meet a fault. */
void hm_begin(const struct hm_plan *plan, unsigned n);

/* Run until nothing is queued or under way, or limit [ms] is over. -> idle. With `ms` only: hm_run. */
bool hm_run_until_idle(unsigned limit_ms);
void hm_run(unsigned ms);

#endif
