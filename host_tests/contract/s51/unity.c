#include "check.h"
#include "unity.h"

struct unity_result XDATA unity_results[UNITY_TESTS];
uint8_t XDATA unity_n;

void unity_failed(uint16_t line, uint16_t expected, uint16_t was)
{
    if (unity_results[unity_n].first_failure)
        return;
    unity_results[unity_n].first_failure = line;
    unity_results[unity_n].expected = expected;
    unity_results[unity_n].was = was;
}

void unity_same(uint16_t line, const uint8_t XDATA *a, const uint8_t XDATA *b, uint8_t n)
{
    uint8_t i;

    for (i = 0; i < n; i++)
        if (a[i] != b[i])
            unity_failed(line, a[i], b[i]);
}

/* The host has a breakpoint here. */
void unity_done(void)
{
    for (;;)
        ;
}
