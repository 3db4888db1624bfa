/* A device for tests: the one of the bus trace of spec A12 (ident 00AAH, F3 7B: 4 + 12 words both ways), which also
 * adapts to every configuration up to 244 octets each way. */
#ifndef DP_ANY_H
#define DP_ANY_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "DP-ANY"
#define DEV_HW_RELEASE "V1.0"
#define DEV_SW_RELEASE "V0.1"
#define DEV_IDENT      0x00AA

#define DEV_MODULES(M)                                                                                         \
    M("4 words in and out", 8, 8, 0xF3)                                                                        \
    M("12 words in and out", 24, 24, 0x7B)

#define DEV_SYNC               1
#define DEV_FREEZE             1
#define DEV_SET_SLAVE_ADD      1
#define DEV_FAIL_SAFE          0
#define DEV_MIN_SLAVE_INTERVAL 1

#define DEV_USER_PRM_MIN 0
#define DEV_USER_PRM_MAX 237
#define DEV_EXT_DIAG_MAX 238
#define DEV_INPUT_MAX    244
#define DEV_OUTPUT_MAX   244
#define DEV_CFG_MAX      244

#endif
