/* DP-TEST01, the prototype device: the one description that firmware and GSD are made from.
 * Four modules: a temperature and a sensor in, two octets out (spec A8; identifier bytes as resolved in A9). */
#ifndef DP_TEST01_H
#define DP_TEST01_H

#define DEV_VENDOR     "Fieldling"
#define DEV_MODEL      "DP-TEST01"
#define DEV_HW_RELEASE "V1.0"
#define DEV_SW_RELEASE "V0.1"
#define DEV_IDENT      0x1234

/*        M(name,                   in, out, identifier) */
#define DEV_MODULES(M)                                                                                          \
    M("Temperature 1 byte in", 1, 0, 0x10)                                                                      \
    M("Octet 1 byte out", 0, 1, 0x20)                                                                           \
    M("Sensor 1 byte in", 1, 0, 0x10)                                                                           \
    M("Octet 1 byte out", 0, 1, 0x20)

#define DEV_SYNC               1
#define DEV_FREEZE             1
#define DEV_SET_SLAVE_ADD      1
#define DEV_FAIL_SAFE          1
#define DEV_MIN_SLAVE_INTERVAL 1 /* 100 us */

/* User parameters, all optional:
 *   octet 1  bit 0 over-temperature is diagnosed, bits 7..1 must be 0
 *   octet 2  temperature limit [degrees], 0 = 50
 *   octet 3  must be 0 */
#define DEV_USER_PRM_MIN 0
#define DEV_USER_PRM_MAX 3

/* Extended diagnosis, device related block: 02 xx, bit 0 over-temperature, bit 1 sensor 2 failed; the console
 * of the host station may put anything else there. */
#define DEV_EXT_DIAG_MAX 58

#endif
