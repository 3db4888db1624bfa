/* The CPU of the F2808: the model's. */
#ifndef F2808_CPU_H
#define F2808_CPU_H

#include "sim/f2808_sci.h"

void contract_restart(uint8_t why);

#define cpu_mask()                   f2808_mask()
#define cpu_unmask()                 f2808_unmask()
#define cpu_idle()                   f2808_idle()
#define cpu_allow()                  f2808_allow(true)
#define cpu_protect()                f2808_allow(false)
#define cpu_vectors(timer0, rx, tx)  f2808_vectors(timer0, rx, tx)
#define cpu_restart(why)             contract_restart(why)

#endif
