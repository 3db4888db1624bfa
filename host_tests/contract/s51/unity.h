/* Unity's words, as far as hal_contract.c says them, for a core that Unity itself is too large for: an assertion that
 * fails writes down its line and the values, the test goes on, and the host reads what happened in external RAM. */
#ifndef UNITY_H
#define UNITY_H

#include <stdint.h>

#define UNITY_TESTS 32u

struct unity_result {
    uint16_t first_failure; /* line, 0: none */
    uint16_t expected, was;
    uint16_t ignored; /* line, 0: it ran */
};

extern struct unity_result XDATA unity_results[UNITY_TESTS];
extern uint8_t XDATA unity_n; /* the test that runs */

void unity_failed(uint16_t line, uint16_t expected, uint16_t was);
void unity_same(uint16_t line, const uint8_t XDATA *a, const uint8_t XDATA *b, uint8_t n);
void unity_done(void);
void setUp(void);
void tearDown(void);

#define UNITY_CHECK(good, a, b)                                                                                        \
    do {                                                                                                               \
        if (!(good))                                                                                                   \
            unity_failed(__LINE__, (uint16_t)(a), (uint16_t)(b));                                                      \
    } while (0)
#define TEST_ASSERT_TRUE(c)                       UNITY_CHECK(c, 1, 0)
#define TEST_ASSERT_EQUAL(a, b)                   UNITY_CHECK((a) == (b), a, b)
#define TEST_ASSERT_NOT_EQUAL(a, b)               UNITY_CHECK((a) != (b), a, a)
#define TEST_ASSERT_EQUAL_UINT8(a, b)             UNITY_CHECK((uint8_t)(a) == (uint8_t)(b), a, b)
#define TEST_ASSERT_EQUAL_HEX8(a, b)              TEST_ASSERT_EQUAL_UINT8(a, b)
#define TEST_ASSERT_GREATER_OR_EQUAL_UINT16(a, b) UNITY_CHECK((uint16_t)(b) >= (uint16_t)(a), a, b)
#define TEST_ASSERT_LESS_OR_EQUAL_UINT16(a, b)    UNITY_CHECK((uint16_t)(b) <= (uint16_t)(a), a, b)
#define TEST_ASSERT_EQUAL_HEX8_ARRAY(a, b, n)     unity_same(__LINE__, a, b, n)
#define TEST_IGNORE_MESSAGE(text)                                                                                      \
    do {                                                                                                               \
        unity_results[unity_n].ignored = __LINE__;                                                                     \
        return;                                                                                                        \
    } while (0)
#define UNITY_BEGIN() (unity_n = 0)
#define RUN_TEST(f)                                                                                                    \
    do {                                                                                                               \
        setUp();                                                                                                       \
        f();                                                                                                           \
        tearDown();                                                                                                    \
        unity_n++;                                                                                                     \
    } while (0)
#define UNITY_END() (unity_done(), 0)

#endif
