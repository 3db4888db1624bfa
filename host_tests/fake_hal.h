/* A machine for module tests: no time and no wire, only what the test says and what the stack asked for.
 *
 * One T_bit is one timer count, so limits of silence read as bit times. Portable like the stack itself: the same tests
 * run on the host, on an 8051 simulator and under QEMU. It notices misuse of the port (fake.misuse), which every
 * tearDown() looks at.
 */
#ifndef FAKE_HAL_H
#define FAKE_HAL_H

#include "hal/hal.h"
#include "unity.h"

#define FAKE_NV_UNLIMITED 255u
#define FAKE_SENT_MAX     513u /* the longest frame of all, in Modbus ASCII */

/* What was done wrong; bits of fake.misuse. */
#define FAKE_UNLOCKED   0x01u /* an isr service called from main without the lock       */
#define FAKE_IN_ISR     0x02u /* a main service called from an interrupt                */
#define FAKE_COLLISION  0x04u /* hal_send() while sending, or of nothing                */
#define FAKE_UNBALANCED 0x08u /* hal_irq_restore() without a hal_irq_save()             */
#define FAKE_ASSERT     0x10u /* hal_reset(): the stack found itself broken             */
#define FAKE_MASKED     0x20u /* the test let an interrupt come while they were masked  */

struct fake_machine {
    /* said by the test */
    uint16_t ticks;       /* hal_ticks()                                           */
    uint8_t line;         /* kind of line: enum hal_line                           */
    hal_dur_t silent_for; /* hal_silent() up to here [T_bit]                       */
    uint32_t fastest;     /* hal_line_open() answers HAL_LINE_NO to a faster rate  */
    uint8_t nv[HAL_NV_SIZE];
    uint8_t nv_writes;    /* that many more are stored; FAKE_NV_UNLIMITED          */
    /* asked by the stack */
    uint32_t rate;        /* of the last good hal_line_open()                      */
    uint8_t format;
    uint8_t opens;
    hal_dur_t limit;      /* of silence [T_bit]                                    */
    bool armed;           /* the next silence of that length has not been told     */
    uint8_t sent[FAKE_SENT_MAX]; /* last frame given to hal_send()                 */
    uint16_t sent_len;    /* 0: none since the last request()                      */
    uint8_t sends;        /* frames in all                                         */
    bool sending;
    bool masked;
    uint8_t isr;          /* depth                                                 */
    uint8_t misuse;
};
extern struct fake_machine XDATA fake;

/* Runs at each end of a lock, as the interrupt that was waiting for it would; 0 = none. */
extern void (*fake_at_unlock)(void);

/* As after power-up: memory erased, timed line, every rate, interrupts on. */
void fake_begin(void);

/* Fails the running test on misuse. */
void fake_end(void);

/* ---- interrupts ---- */
void fake_octet(uint8_t octet, uint8_t err);
void fake_silence(void); /* the line has been silent for fake.limit */
void fake_sent(void);    /* the last stop bit of hal_send() is out  */

/* ---- telegrams, as octets in hexadecimal: "10 08 02 49 53 16" ---- */
void hear(const char *hex);                    /* octets, one after the other                            */
void hear_repeated(uint8_t octet, uint8_t n);  /* the same octet n times                                 */
void request(const char *hex);                 /* T_SYN, the octets, then silence until any answer is out */
void finish_request(void);                     /* the silence after it                                   */

/* The answer to the last request() was / there was none. */
#define ANSWERED(hex) assert_octets(hex, fake.sent, fake.sent_len, __LINE__)
#define NOT_ANSWERED() assert_octets("", fake.sent, fake.sent_len, __LINE__)
#define OCTETS(hex, actual, len) assert_octets(hex, actual, len, __LINE__)
void assert_octets(const char *hex, const uint8_t XDATA *actual, uint16_t len, UNITY_LINE_TYPE line);

/* Octets in hexadecimal into `to` -> how many. */
uint8_t from_hex(uint8_t XDATA *to, const char *hex);

#endif
