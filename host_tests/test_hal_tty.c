/* The port in real time on a serial port whose driver is played by this test: ioctl() is replaced at link time, and the
 * device is a FIFO, which gives back what is written to it, as a bus without echo suppression does. Constants:
 * termios(3), ioctl_tty(2). */
#include "unity.h"
#include "hal/hal.h"
#include "hal_host.h"
#include "line.h"

#include <asm/termbits.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static char folder[] = P_tmpdir "/fieldling-XXXXXX";
static char device[64];
static int far_end;

/* ---- the driver ------------------------------------------------------------------------------------------ */

static struct driver {
    struct termios2 now;
    tcflag_t cannot;  /* c_cflag bits it drops silently            */
    unsigned fastest; /* it sets this rate for anything above      */
    unsigned off;     /* it is so many bit/s too fast              */
    bool refuses;     /* TCSETS2 fails                             */
    bool has_rs485;
    int queued; /* TIOCOUTQ                                  */
    struct serial_rs485 rs485;
    int flags; /* serial_struct                             */
    unsigned flushes, exclusive;
} driver;

static int set_termios(const struct termios2 *t)
{
    if (driver.refuses) {
        errno = EINVAL;
        return -1;
    }
    driver.now = *t;
    driver.now.c_cflag &= ~driver.cannot;
    if (driver.now.c_ospeed > driver.fastest)
        driver.now.c_ospeed = driver.now.c_ispeed = driver.fastest;
    driver.now.c_ospeed += driver.off;
    return 0;
}

int __wrap_ioctl(int fd, unsigned long request, ...);
int __wrap_ioctl(int fd, unsigned long request, ...)
{
    va_list arguments;
    void *p;

    (void)fd;
    va_start(arguments, request);
    p = va_arg(arguments, void *);
    va_end(arguments);
    switch (request) {
    case TCGETS2:
        *(struct termios2 *)p = driver.now;
        return 0;
    case TCSETS2:
        return set_termios(p);
    case TCFLSH:
        driver.flushes++;
        return 0;
    case TIOCEXCL:
        driver.exclusive++;
        return 0;
    case TIOCOUTQ:
        *(int *)p = driver.queued;
        driver.queued = 0;
        return 0;
    case TIOCSRS485:
        driver.rs485 = *(struct serial_rs485 *)p;
        break;
    case TIOCGSERIAL:
        memset(p, 0, sizeof(struct serial_struct));
        return 0;
    case TIOCSSERIAL:
        driver.flags = ((struct serial_struct *)p)->flags;
        return 0;
    default:
        break;
    }
    errno = ENOTTY;
    return driver.has_rs485 && request == TIOCSRS485 ? 0 : -1;
}

/* ---- the stack above --------------------------------------------------------------------------------------- */

static char upcalls[512]; /* o = good octet, p = parity, b = break, t = sent */
static uint8_t heard[512];
static size_t n_upcalls;

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    heard[n_upcalls] = octet;
    upcalls[n_upcalls++] = err & HAL_ERR_BREAK ? 'b' : err ? 'p' : 'o';
}

void line_silence_isr(void) IN_ISR
{
}

void line_sent_isr(void) IN_ISR
{
    upcalls[n_upcalls++] = 't';
}

static uint64_t now_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

static void run_until(size_t n)
{
    uint64_t end = now_us() + 2000000u;

    while (n_upcalls < n && now_us() < end)
        hal_idle();
}

static void run_ms(unsigned ms)
{
    uint64_t end = now_us() + ms * 1000u;

    while (now_us() < end)
        hal_idle();
}

static void on_the_line(const char *octets, size_t n)
{
    TEST_ASSERT_EQUAL(n, write(far_end, octets, n));
}

void setUp(void)
{
    driver = (struct driver){.fastest = 4000000, .now = {.c_cflag = CS8 | CREAD | B9600, .c_ospeed = 9600}};
    hal_irq_restore(HAL_IRQ_ON);
    run_ms(0);
    memset(upcalls, 0, sizeof upcalls);
    n_upcalls = 0;
}

void tearDown(void)
{
}

/* ---- what is asked of the driver ------------------------------------------------------------------------------ */

static void profibus_is_8e1_at_any_rate_with_errors_marked(void)
{
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(93750, HAL_8E1));
    TEST_ASSERT_EQUAL_HEX32(BOTHER, driver.now.c_cflag & CBAUD);
    TEST_ASSERT_EQUAL(93750, driver.now.c_ospeed);
    TEST_ASSERT_EQUAL(93750, driver.now.c_ispeed);
    TEST_ASSERT_EQUAL_HEX32(CS8 | PARENB, driver.now.c_cflag & (CSIZE | PARENB | PARODD | CSTOPB));
    TEST_ASSERT_EQUAL_HEX32(INPCK | PARMRK, driver.now.c_iflag);
    TEST_ASSERT_EQUAL_HEX32(0, driver.now.c_oflag | driver.now.c_lflag);
    TEST_ASSERT_EQUAL_MESSAGE(1, driver.flushes, "the receiver is emptied");
}

static void every_format_is_asked_for_as_it_is(void)
{
    static const tcflag_t bits[HAL_FORMATS] = {CS8 | PARENB, CS8 | PARENB | PARODD, CS8 | CSTOPB, CS8,
                                               CS7 | PARENB, CS7 | PARENB | PARODD, CS7 | CSTOPB};

    for (uint8_t format = 0; format < HAL_FORMATS; format++) {
        TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(19200, format));
        TEST_ASSERT_EQUAL_HEX32(bits[format], driver.now.c_cflag & (CSIZE | PARENB | PARODD | CSTOPB));
    }
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(19200, HAL_FORMATS));
}

static void a_driver_without_parity_is_found_out_and_left_as_it_was(void)
{
    struct termios2 before = driver.now;

    driver.cannot = PARENB;
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(19200, HAL_8E1));
    TEST_ASSERT_EQUAL_MEMORY(&before, &driver.now, sizeof before);
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(19200, HAL_8N1));
}

static void a_rate_the_driver_cannot_do_is_refused(void)
{
    struct termios2 before = driver.now;

    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(12000000, HAL_8E1));
    TEST_ASSERT_EQUAL_MEMORY(&before, &driver.now, sizeof before);
    driver.off = 300; /* 3 % of 9600 */
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(9600, HAL_8E1));
    driver.off = 15; /* 0.16 %, 12 MHz divided by 78 */
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(9600, HAL_8E1));
    driver.refuses = true;
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(19200, HAL_8E1));
}

static void driver_enable_and_low_latency_are_used_where_they_are(void)
{
    struct line line;

    driver.has_rs485 = true;
    TEST_ASSERT_NULL(line_tty_open(&line, device));
    TEST_ASSERT_EQUAL_HEX32(SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND, driver.rs485.flags);
    TEST_ASSERT_EQUAL_HEX32(ASYNC_LOW_LATENCY, driver.flags);
    TEST_ASSERT_EQUAL(1, driver.exclusive);
    close(line.fd);
    driver.has_rs485 = false;
    TEST_ASSERT_NULL_MESSAGE(line_tty_open(&line, device), "an adapter that switches by itself is as good");
    close(line.fd);
}

static void settings_are_put_back_at_the_end(void)
{
    struct termios2 before = driver.now;
    struct line line;

    TEST_ASSERT_NULL(line_tty_open(&line, device));
    TEST_ASSERT_TRUE(line.set(&line, 500000, HAL_8E1));
    TEST_ASSERT_EQUAL(500000, driver.now.c_ospeed);
    line.close(&line);
    TEST_ASSERT_EQUAL_MEMORY(&before, &driver.now, sizeof before);
}

/* ---- octets ---------------------------------------------------------------------------------------------- */

static void marked_octets_arrive_with_their_errors(void)
{
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(500000, HAL_8E1));
    on_the_line("\x68\xFF\xFF\xFF", 4); /* a mark may be cut in two by read() */
    run_until(2);
    on_the_line("\x00\x41\xFF\x00\x00\x16", 6);
    run_until(5);
    TEST_ASSERT_EQUAL_STRING("oopbo", upcalls);
    TEST_ASSERT_EQUAL_HEX8(0xFF, heard[1]);
    TEST_ASSERT_EQUAL_HEX8(0x41, heard[2]);
    TEST_ASSERT_EQUAL_HEX8(0x16, heard[4]);
}

static void sent_is_reported_after_the_last_stop_bit_and_our_echo_is_not_heard(void)
{
    static const uint8_t run[20];
    uint64_t start;

    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(19200, HAL_8E1));
    start = now_us();
    hal_send(run, sizeof run);
    run_until(1);
    TEST_ASSERT_EQUAL_STRING("t", upcalls);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(11458,
                                      now_us() - start); /* 20 octets * 11 bits / 19200 bit/s = 11458.3 us */
    on_the_line("\x10", 1);
    run_until(2);
    TEST_ASSERT_EQUAL_STRING("to", upcalls);
}

static void what_the_driver_still_holds_delays_the_report(void)
{
    static const uint8_t run[2];
    uint64_t start;

    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(19200, HAL_8E1));
    driver.queued = 10;
    start = now_us();
    hal_send(run, sizeof run);
    run_until(1);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(6875, now_us() - start); /* (2 + 10) octets * 11 bits / 19200 bit/s */
}

/* A character of 8N1 has 10 bits, one of 8E1 11. */
static void a_character_is_as_long_as_its_format_says(void)
{
    static const uint8_t run[100];
    uint64_t start;

    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(100000, HAL_8N1));
    start = now_us();
    hal_send(run, sizeof run);
    run_until(1);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(10000, now_us() - start);
}

static void clean_up(void)
{
    unlink(device);
    rmdir(folder);
}

int main(void)
{
    struct hal_host host = {.line = device};
    const char *wrong;

    UNITY_BEGIN();
    if (!mkdtemp(folder))
        return 1;
    atexit(clean_up);
    snprintf(device, sizeof device, "%s/port", folder);
    if (mkfifo(device, 0600) != 0)
        return 1;
    far_end = open(device, O_RDWR | O_NONBLOCK);
    wrong = hal_host_open(&host);
    if (wrong) {
        puts(wrong);
        return 1;
    }
    hal_init();
    RUN_TEST(profibus_is_8e1_at_any_rate_with_errors_marked);
    RUN_TEST(every_format_is_asked_for_as_it_is);
    RUN_TEST(a_driver_without_parity_is_found_out_and_left_as_it_was);
    RUN_TEST(a_rate_the_driver_cannot_do_is_refused);
    RUN_TEST(driver_enable_and_low_latency_are_used_where_they_are);
    RUN_TEST(settings_are_put_back_at_the_end);
    RUN_TEST(marked_octets_arrive_with_their_errors);
    RUN_TEST(sent_is_reported_after_the_last_stop_bit_and_our_echo_is_not_heard);
    RUN_TEST(what_the_driver_still_holds_delays_the_report);
    RUN_TEST(a_character_is_as_long_as_its_format_says);
    return UNITY_END();
}
