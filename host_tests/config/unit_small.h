/* A part with little RAM: telegram bodies of 40 octets are stored, two indications wait, nine SAPs. */
#ifndef UNIT_SMALL_H
#define UNIT_SMALL_H

#include "unit_dp.h"

#define FDL_BODY_MAX 40
#define FDL_BOXES    2
#define FDL_SAPS     9

#endif
