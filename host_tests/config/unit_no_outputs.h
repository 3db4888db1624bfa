/* A device with inputs only: two octets to the master, nothing from it. */
#ifndef UNIT_NO_OUTPUTS_H
#define UNIT_NO_OUTPUTS_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "UNIT-IN"
#define DEV_HW_RELEASE "H1"
#define DEV_SW_RELEASE "S1"
#define DEV_IDENT      0x1234

#define DEV_MODULES(M) M("2 byte in", 2, 0, 0x11)

#define DEV_SYNC               1
#define DEV_FREEZE             1
#define DEV_SET_SLAVE_ADD      1
#define DEV_FAIL_SAFE          1
#define DEV_MIN_SLAVE_INTERVAL 1
#define DEV_USER_PRM_MIN       0
#define DEV_USER_PRM_MAX       0
#define DEV_EXT_DIAG_MAX       12

#endif
