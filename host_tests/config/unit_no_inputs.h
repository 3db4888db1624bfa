/* A device with outputs only: two octets from the master, nothing to it. */
#ifndef UNIT_NO_INPUTS_H
#define UNIT_NO_INPUTS_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "UNIT-OUT"
#define DEV_HW_RELEASE "H1"
#define DEV_SW_RELEASE "S1"
#define DEV_IDENT      0x1234

#define DEV_MODULES(M) M("2 byte out", 0, 2, 0x21)

#define DEV_SYNC               1
#define DEV_FREEZE             1
#define DEV_SET_SLAVE_ADD      1
#define DEV_FAIL_SAFE          1
#define DEV_MIN_SLAVE_INTERVAL 1
#define DEV_USER_PRM_MIN       0
#define DEV_USER_PRM_MAX       0
#define DEV_EXT_DIAG_MAX       12

#endif
