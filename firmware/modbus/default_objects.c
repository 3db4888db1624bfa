#include "modbus/mb.h"

const struct mb_object CODE mb_objects[] = {{0, "Fieldling"}, {1, "0"}, {2, "0"}, {0, NULL}};
