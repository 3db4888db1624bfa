#include "fake_hal.h"

struct fake_machine XDATA fake;
void (*fake_at_unlock)(void);

static bool at_unlock; /* fake_at_unlock() is running */

void fake_begin(void)
{
    uint8_t i;

    fake.ticks = 0;
    fake.line = HAL_LINE_TIMED;
    fake.silent_for = 0;
    fake.fastest = 12000000u;
    for (i = 0; i < HAL_NV_SIZE; i++)
        fake.nv[i] = 0xFF;
    fake.nv_writes = FAKE_NV_UNLIMITED;
    fake.rate = 0;
    fake.format = 0xFF;
    fake.opens = 0;
    fake.limit = 0;
    fake.armed = false;
    fake.sent_len = 0;
    fake.sends = 0;
    fake.sending = false;
    fake.masked = false;
    fake.isr = 0;
    fake.misuse = 0;
    fake_at_unlock = 0;
    at_unlock = false;
}

void fake_end(void)
{
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, fake.misuse, "the port was misused");
    TEST_ASSERT_FALSE_MESSAGE(fake.masked, "interrupts were left masked");
}

/* ---- the port -------------------------------------------------------------------------------------------- */

static void main_service(void)
{
    if (fake.isr)
        fake.misuse |= FAKE_IN_ISR;
}

static void isr_service(void)
{
    if (!fake.isr && !fake.masked)
        fake.misuse |= FAKE_UNLOCKED;
}

uint8_t hal_irq_save(void)
{
    uint8_t state = (uint8_t)(fake.masked ? 0 : HAL_IRQ_ON);

    main_service();
    fake.masked = true;
    return state;
}

void hal_irq_restore(uint8_t state)
{
    main_service();
    if (!fake.masked)
        fake.misuse |= FAKE_UNBALANCED;
    if (state != HAL_IRQ_ON)
        return;
    fake.masked = false;
    if (fake_at_unlock && !at_unlock) {
        at_unlock = true;
        fake_at_unlock();
        at_unlock = false;
    }
}

uint16_t hal_ticks(void)
{
    main_service();
    return fake.ticks;
}

uint8_t hal_nv_read(uint8_t index)
{
    main_service();
    return fake.nv[index];
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    main_service();
    if (fake.nv_writes == 0)
        return false;
    if (fake.nv_writes != FAKE_NV_UNLIMITED)
        fake.nv_writes--;
    fake.nv[index] = value;
    return true;
}

/* Returns, which a real one never does: a test can then say what happened. */
void hal_reset(uint8_t why)
{
    (void)why;
    fake.misuse |= FAKE_ASSERT;
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    main_service();
    if (bit_per_s > fake.fastest)
        return HAL_LINE_NO;
    fake.rate = bit_per_s;
    fake.format = format;
    fake.limit = 0;
    fake.armed = false;
    fake.sending = false;
    fake.opens++;
    return fake.line;
}

hal_dur_t hal_tbit(uint16_t n)
{
    main_service();
    return n;
}

void hal_silence(hal_dur_t d) IN_ISR
{
    isr_service();
    fake.limit = d;
    fake.armed = d != 0;
}

bool hal_silent(hal_dur_t d) IN_ISR
{
    isr_service();
    return d <= fake.silent_for;
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    uint16_t i;

    isr_service();
    if (fake.sending || n == 0 || n > sizeof fake.sent)
        fake.misuse |= FAKE_COLLISION;
    for (i = 0; i < n && i < sizeof fake.sent; i++)
        fake.sent[i] = octets[i];
    fake.sent_len = n;
    fake.sends++;
    fake.sending = true;
}

/* ---- interrupts ------------------------------------------------------------------------------------------ */

static void enter_isr(void)
{
    if (fake.masked)
        fake.misuse |= FAKE_MASKED;
    fake.isr++;
}

void fake_octet(uint8_t octet, uint8_t err)
{
    enter_isr();
    fake.armed = fake.limit != 0;
    line_octet_isr(octet, err);
    fake.isr--;
}

void fake_silence(void)
{
    enter_isr();
    fake.armed = false;
    line_silence_isr();
    fake.isr--;
}

void fake_sent(void)
{
    enter_isr();
    fake.sending = false;
    fake.armed = fake.limit != 0;
    line_sent_isr();
    fake.isr--;
}

/* ---- telegrams ------------------------------------------------------------------------------------------- */

static uint8_t digit(char c)
{
    return (uint8_t)(c <= '9' ? c - '0' : c - 'A' + 10);
}

/* The next octet of *hex, which moves on; false at the end. */
static bool next_octet(const char **hex, uint8_t *octet)
{
    while (**hex == ' ')
        ++*hex;
    if (**hex == 0)
        return false;
    *octet = (uint8_t)((uint8_t)(digit((*hex)[0]) << 4) | digit((*hex)[1]));
    *hex += 2;
    return true;
}

uint8_t from_hex(uint8_t XDATA *to, const char *hex)
{
    uint8_t octet;
    uint8_t n = 0;

    while (next_octet(&hex, &octet))
        to[n++] = octet;
    return n;
}

void hear(const char *hex)
{
    uint8_t octet;

    while (next_octet(&hex, &octet))
        fake_octet(octet, 0);
}

void hear_repeated(uint8_t octet, uint8_t n)
{
    for (; n; n--)
        fake_octet(octet, 0);
}

void finish_request(void)
{
    fake_silence();
    if (fake.sending)
        fake_sent();
}

void request(const char *hex)
{
    fake.sent_len = 0;
    fake_silence();
    hear(hex);
    finish_request();
}

void assert_octets(const char *hex, const uint8_t XDATA *actual, uint16_t len, UNITY_LINE_TYPE line)
{
    static uint8_t XDATA expected[256];
    uint8_t n = from_hex(expected, hex);

    UNITY_TEST_ASSERT_EQUAL_UINT16(n, len, line, "number of octets");
    if (n && n == len)
        UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, actual, n, line, 0);
}
