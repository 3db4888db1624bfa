/* A modular device that adapts: one octet each way by itself, up to eight each way as the master configures it. */
#ifndef UNIT_ADAPT_H
#define UNIT_ADAPT_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "UNIT-ADAPT"
#define DEV_HW_RELEASE "H1"
#define DEV_SW_RELEASE "S1"
#define DEV_IDENT      0x1234

#define DEV_MODULES(M)                                                                                          \
    M("1 byte in", 1, 0, 0x10)                                                                                  \
    M("1 byte out", 0, 1, 0x20)

#define DEV_INPUT_MAX  8
#define DEV_OUTPUT_MAX 8
#define DEV_CFG_MAX    6

#define DEV_SYNC               1
#define DEV_FREEZE             1
#define DEV_SET_SLAVE_ADD      1
#define DEV_FAIL_SAFE          1
#define DEV_MIN_SLAVE_INTERVAL 1
#define DEV_USER_PRM_MIN       0
#define DEV_USER_PRM_MAX       0
#define DEV_EXT_DIAG_MAX       12

#endif
