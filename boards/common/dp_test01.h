/* DP-TEST01, the prototype device: the one description that firmware and GSD are made from.
 * Four modules: a temperature and a sensor in, two octets out (spec A8; identifier bytes as resolved in A9). */
#ifndef DP_TEST01_H
#define DP_TEST01_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "DP-TEST01"
#define DEV_HW_RELEASE "V1.0"
#define DEV_SW_RELEASE "V0.1"
#define DEV_IDENT      0x1234
#define DEV_ORDER      "FL-DP-TEST01"
#define DEV_FAMILY     "0@Fieldling@Prototypes" /* 0: general */

/* M(name, in, out, identifier...) */
#define DEV_MODULES(M)                                                                                          \
    M("Temperature, 1 byte in", 1, 0, 0x10)                                                                     \
    M("Output 1, 1 byte out", 0, 1, 0x20)                                                                       \
    M("Sensor, 1 byte in", 1, 0, 0x10)                                                                          \
    M("Output 2, 1 byte out", 0, 1, 0x20)

#define DEV_SYNC               1
#define DEV_FREEZE             1
#define DEV_SET_SLAVE_ADD      1
#define DEV_FAIL_SAFE          1
#define DEV_MIN_SLAVE_INTERVAL 1 /* 100 us */

/* User parameters, all optional; what is not named here (octet 1 bits 7..1, octet 3) must be 0. */
#define DEV_USER_PRM_MIN 0
#define DEV_USER_PRM_MAX 3
#define DEV_USER_PRM(BIT, OCTET)                                                                                \
    BIT(0, 0, 1, "Over-temperature is diagnosed")                                                               \
    OCTET(1, 0, 0, 100, "Temperature limit [degrees], 0 = 50")

/* Extended diagnosis, device related block 02 xx, bits of xx; the console of the host station may put anything
 * else there. */
#define DEV_EXT_DIAG_MAX 58
#define DEV_DIAG_BITS(D) D(0, "Over-temperature")

#endif
