/* A device without anything optional: no Sync, no Freeze, no Set_Slave_Add, no Fail_Safe, no extended diagnosis; it wants
 * one or two user parameters, stays in data exchange after a wrong output length, and implements no callback. */
#ifndef UNIT_PLAIN_H
#define UNIT_PLAIN_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "UNIT-PLAIN"
#define DEV_HW_RELEASE "H1"
#define DEV_SW_RELEASE "S1"
#define DEV_IDENT      0x00AA

#define DEV_MODULES(M) M("1 byte in, 1 byte out", 1, 1, 0x30)

#define DEV_SYNC               0
#define DEV_FREEZE             0
#define DEV_SET_SLAVE_ADD      0
#define DEV_FAIL_SAFE          0
#define DEV_MIN_SLAVE_INTERVAL 1
#define DEV_USER_PRM_MIN       1
#define DEV_USER_PRM_MAX       2
#define DEV_EXT_DIAG_MAX       0

#define DDLM_WRONG_LENGTH_LEAVES 0

#endif
