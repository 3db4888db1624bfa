/* expect: fdl includes hal/posix/line.h: of the port, only hal/hal.h */
#include "hal/posix/line.h"
