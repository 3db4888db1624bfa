/* expect: the simulation includes fdl/fdl.h of the firmware */
#include "fdl/fdl.h"
