/* The end of a test image: a debugger or a test machine with semihosting hears the status. Source: ARM semihosting
 * specification, SYS_EXIT_EXTENDED. Without one the break point is a fault. */
#ifndef LM3S6965EVB_SEMIHOSTING_H
#define LM3S6965EVB_SEMIHOSTING_H

#include <stdint.h>

#define SYS_EXIT_EXTENDED     0x20
#define REASON_APPLICATION_EXIT 0x20026u

static inline void semihosting_exit(uint32_t status)
{
    const uint32_t block[2] = {REASON_APPLICATION_EXIT, status};
    register uint32_t r0 __asm__("r0") = SYS_EXIT_EXTENDED;
    register const uint32_t *r1 __asm__("r1") = block;

    __asm__ volatile("bkpt 0xAB" : : "r"(r0), "r"(r1) : "memory");
}

#endif
