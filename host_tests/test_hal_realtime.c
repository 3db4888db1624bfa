/* The contract of hal.h kept by the port in real time, with a master that opens, writes and reads the other
 * end of the pseudo terminal in the same process. Nothing sleeps but hal_idle(); every wait is bounded. */
#define _GNU_SOURCE
#include "unity.h"
#include "hal/hal.h"
#include "hal_host.h"
#include "line.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

static char folder[] = P_tmpdir "/fieldling-XXXXXX";
static char link_path[64], pty_spec[72];

/* ---- the stack above the port: notes every upcall ------------------------------------------------------ */

static char upcalls[8192]; /* o = octet, e = octet with an error, s = silence, t = sent */
static uint8_t heard[8192];
static size_t upcalls_n, heard_n;
static hal_dur_t limit_after_octet; /* != 0: set by line_octet_isr(), as phy_uart does for T_SDR */
static const uint8_t *answer;       /* != 0: sent by line_silence_isr(), once */
static uint16_t answer_n;

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    upcalls[upcalls_n++] = err ? 'e' : 'o';
    heard[heard_n++] = octet;
    if (limit_after_octet)
        hal_silence(limit_after_octet);
}

void line_silence_isr(void) IN_ISR
{
    upcalls[upcalls_n++] = 's';
    if (answer)
        hal_send(answer, answer_n);
    answer = NULL;
}

void line_sent_isr(void) IN_ISR
{
    upcalls[upcalls_n++] = 't';
}

static uint64_t now_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

static void forget(void)
{
    memset(upcalls, 0, sizeof upcalls);
    upcalls_n = heard_n = 0;
}

/* Let the port work until n upcalls are there, at most 2 s. */
static void run_until(size_t n)
{
    uint64_t end = now_us() + 2000000u;

    while (upcalls_n < n && now_us() < end)
        hal_idle();
}

static void run_ms(unsigned ms)
{
    uint64_t end = now_us() + ms * 1000u;

    while (now_us() < end)
        hal_idle();
}

/* ---- the master ------------------------------------------------------------------------------------------ */

static int master_open(void)
{
    int fd = open(link_path, O_RDWR | O_NOCTTY | O_NONBLOCK);

    TEST_ASSERT_TRUE_MESSAGE(fd >= 0, "the link leads to a terminal");
    return fd;
}

static void master_says(int fd, const char *octets)
{
    TEST_ASSERT_EQUAL(strlen(octets), write(fd, octets, strlen(octets)));
}

static const char *master_hears(int fd)
{
    static char text[64];
    ssize_t n;

    n = read(fd, text, sizeof text - 1u);
    text[n > 0 ? n : 0] = '\0';
    return text;
}

void setUp(void)
{
    limit_after_octet = 0;
    answer = NULL;
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(500000u, HAL_8E1));
    hal_irq_restore(HAL_IRQ_ON);
    run_ms(1); /* see the master of the last test go */
    forget();
}

void tearDown(void)
{
}

/* ---- octets ---------------------------------------------------------------------------------------------- */

static void octets_come_in_order_every_value_without_error(void)
{
    uint8_t all[256];
    int m = master_open();

    for (unsigned i = 0; i < sizeof all; i++)
        all[i] = (uint8_t)i;
    TEST_ASSERT_EQUAL(sizeof all, write(m, all, sizeof all));
    run_until(sizeof all);
    TEST_ASSERT_EQUAL(sizeof all, heard_n);
    TEST_ASSERT_EQUAL_MEMORY(all, heard, sizeof all);
    TEST_ASSERT_NULL(memchr(upcalls, 'e', sizeof all));
    close(m);
}

static void nothing_is_called_while_masked(void)
{
    int m = master_open();
    uint8_t state = hal_irq_save();

    TEST_ASSERT_EQUAL(HAL_IRQ_ON, state);
    TEST_ASSERT_NOT_EQUAL(HAL_IRQ_ON, hal_irq_save());
    master_says(m, "x");
    for (int i = 0; i < 100; i++)
        hal_idle();
    TEST_ASSERT_EQUAL(0, upcalls_n);
    hal_irq_restore(state);
    run_until(1);
    TEST_ASSERT_EQUAL_STRING("o", upcalls);
    close(m);
}

static void a_run_is_sent_whole_and_then_reported_once(void)
{
    int m = master_open();

    run_ms(1);
    hal_send((const uint8_t *)"answer", 6);
    TEST_ASSERT_EQUAL_STRING_MESSAGE("", upcalls, "never from inside hal_send()");
    run_until(1);
    run_ms(2);
    TEST_ASSERT_EQUAL_STRING("t", upcalls);
    TEST_ASSERT_EQUAL_STRING("answer", master_hears(m));
    close(m);
}

static void with_the_loop_octets_come_back_and_nothing_reaches_the_line(void)
{
    int m = master_open();

    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(500000u, HAL_8E1 | HAL_LOOP));
    run_ms(1);
    hal_send((const uint8_t *)"abc", 3);
    run_until(4);
    TEST_ASSERT_EQUAL_STRING("ooot", upcalls);
    TEST_ASSERT_EQUAL_MEMORY("abc", heard, 3);
    TEST_ASSERT_EQUAL_STRING("", master_hears(m));
    master_says(m, "not heard");
    run_ms(5);
    TEST_ASSERT_EQUAL(4, upcalls_n);
    close(m);
}

static void a_master_that_never_reads_does_not_stop_the_station(void)
{
    static uint8_t run[250];
    int m = master_open();

    run_ms(1);
    for (unsigned sent = 1; sent <= 400; sent++) { /* 100 kB: far more than a pty holds */
        uint64_t start = now_us();

        forget();
        hal_send(run, sizeof run);
        run_until(1);
        TEST_ASSERT_EQUAL_STRING("t", upcalls);
        if (now_us() - start > 50000u) { /* full, and the run given up */
            close(m);
            return;
        }
    }
    TEST_FAIL_MESSAGE("the pty never filled");
}

/* ---- silence --------------------------------------------------------------------------------------------- */

static void silence_is_called_once_and_not_before_its_time(void)
{
    int m = master_open();
    uint64_t start;

    limit_after_octet = hal_tbit(2500); /* 5 ms at 500 kbit/s */
    start = now_us();
    master_says(m, "x");
    run_until(2);
    TEST_ASSERT_TRUE(now_us() - start >= 5000u);
    run_ms(20);
    TEST_ASSERT_EQUAL_STRING("os", upcalls);
    close(m);
}

static void silence_that_has_been_long_enough_is_called_at_once_but_not_inside(void)
{
    hal_silence(0);
    run_ms(3);
    hal_silence(hal_tbit(500));
    TEST_ASSERT_EQUAL_STRING("", upcalls);
    run_until(1);
    TEST_ASSERT_EQUAL_STRING("s", upcalls);
}

static void an_octet_that_has_arrived_cancels_silence_that_has_run_out(void)
{
    int m = master_open();
    uint8_t state;

    limit_after_octet = hal_tbit(500); /* 1 ms */
    master_says(m, "x");
    run_until(1);
    state = hal_irq_save();
    master_says(m, "y");
    run_ms(3);
    TEST_ASSERT_EQUAL_STRING("o", upcalls);
    hal_irq_restore(state);
    hal_idle();
    TEST_ASSERT_EQUAL_STRING("oo", upcalls);
    close(m);
}

static void octets_of_one_run_have_no_silence_between_them(void)
{
    int m = master_open();

    limit_after_octet = hal_tbit(11); /* 22 us: over before the kernel could wake us */
    master_says(m, "two telegrams");
    run_until(14);
    run_ms(2);
    TEST_ASSERT_EQUAL_STRING("ooooooooooooos", upcalls);
    close(m);
}

/* phy_uart hears nothing before T_SYN of silence: the first request of a master that is quick is not lost by that. */
static void a_pty_has_been_silent_before_it_was_opened(void)
{
    int m = master_open();

    run_ms(1);
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(500000u, HAL_8E1));
    hal_silence(hal_tbit(60000));
    master_says(m, "x");
    run_until(2);
    TEST_ASSERT_EQUAL_STRING("so", upcalls);
    close(m);
}

static void no_limit_no_call(void)
{
    int m = master_open();

    master_says(m, "x");
    run_until(1);
    hal_silence(hal_tbit(500));
    hal_silence(0);
    run_ms(5);
    TEST_ASSERT_EQUAL_STRING("o", upcalls);
    close(m);
}

static void an_answer_after_silence_reaches_the_master(void)
{
    int m = master_open();

    limit_after_octet = hal_tbit(11);
    answer = (const uint8_t *)"yes";
    answer_n = 3;
    master_says(m, "?");
    run_until(3);
    TEST_ASSERT_EQUAL_STRING_LEN("ost", upcalls, 3); /* then silence after our own octets */
    TEST_ASSERT_EQUAL_STRING("yes", master_hears(m));
    close(m);
}

/* ---- masters come and go --------------------------------------------------------------------------------- */

static void what_is_sent_to_nobody_is_lost_and_reported_as_sent(void)
{
    int m;

    hal_send((const uint8_t *)"lost", 4);
    run_until(1);
    TEST_ASSERT_EQUAL_STRING("t", upcalls);
    m = master_open();
    run_ms(1);
    TEST_ASSERT_EQUAL_STRING("", master_hears(m));
    close(m);
}

static void each_of_a_hundred_masters_is_served(void)
{
    for (int i = 0; i < 100; i++) {
        int m = master_open();

        forget();
        master_says(m, "hello");
        run_until(5);
        TEST_ASSERT_EQUAL_STRING("ooooo", upcalls);
        hal_send((const uint8_t *)"hi", 2);
        run_until(6);
        TEST_ASSERT_EQUAL_STRING("hi", master_hears(m));
        close(m);
    }
}

/* The second master opens before the port has had a chance to see the first one go. */
static void a_new_master_does_not_read_what_an_old_one_left(void)
{
    for (int i = 0; i < 100; i++) {
        int m = master_open();

        forget();
        run_ms(1);
        hal_send((const uint8_t *)"for the first", 13);
        run_until(1);
        if (i % 2)
            run_ms(0);
        close(m);
        m = master_open();
        if (i % 4 >= 2)
            master_says(m, "?");
        hal_idle();
        hal_idle();
        TEST_ASSERT_EQUAL_STRING("", master_hears(m));
        close(m);
    }
}

static void what_a_master_said_before_it_went_is_heard(void)
{
    int m = master_open();

    run_ms(1);
    master_says(m, "last words");
    close(m);
    run_until(10);
    TEST_ASSERT_EQUAL_MEMORY("last words", heard, 10);
}

/* glibc answers EINVAL to a tcsetattr() with parity that changes nothing else, because a pty drops PARENB. */
static void each_master_can_set_8e1_again(void)
{
    for (int i = 0; i < 3; i++) {
        struct termios t;
        int m = master_open();

        run_ms(1);
        TEST_ASSERT_EQUAL(0, tcgetattr(m, &t));
        cfmakeraw(&t);
        t.c_cflag |= PARENB;
        cfsetspeed(&t, B19200);
        TEST_ASSERT_EQUAL(0, tcsetattr(m, TCSANOW, &t));
        close(m);
        run_ms(1);
    }
}

static void idle_takes_hardly_any_processor_time_with_and_without_a_master(void)
{
    for (int round = 0; round < 2; round++) {
        int m = round ? master_open() : -1;
        struct rusage before, after;
        long us;

        run_ms(1);
        getrusage(RUSAGE_SELF, &before);
        run_ms(200);
        getrusage(RUSAGE_SELF, &after);
        us = (after.ru_utime.tv_sec - before.ru_utime.tv_sec + after.ru_stime.tv_sec -
              before.ru_stime.tv_sec) *
                 1000000 +
             after.ru_utime.tv_usec - before.ru_utime.tv_usec + after.ru_stime.tv_usec -
             before.ru_stime.tv_usec;
        TEST_ASSERT_TRUE_MESSAGE(us < 40000, "less than a fifth of the time");
        TEST_ASSERT_TRUE_MESSAGE(after.ru_nvcsw - before.ru_nvcsw < 150, "about 250 wake-ups a second");
        if (m >= 0)
            close(m);
    }
}

/* ---- times, rates ---------------------------------------------------------------------------------------- */

static void bit_times_are_rounded_up_and_saturate(void)
{
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(1500000u, HAL_8E1));
    TEST_ASSERT_EQUAL(7334, hal_tbit(11)); /* 7333.3 ns */
    TEST_ASSERT_EQUAL(HAL_LINE_UNTIMED, hal_line_open(9600u, HAL_8N1));
    TEST_ASSERT_EQUAL(3437500, hal_tbit(33));
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFFu, hal_tbit(65535)); /* 6.8 s */
}

static void a_rate_of_nothing_is_refused_and_changes_nothing(void)
{
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(0, HAL_8E1));
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(9600, HAL_FORMATS));
    TEST_ASSERT_EQUAL(22000, hal_tbit(11));
}

static void ticks_are_milliseconds(void)
{
    uint16_t before = hal_ticks();
    uint64_t start = now_us();
    uint16_t passed;

    run_ms(20);
    passed = (uint16_t)(hal_ticks() - before);
    TEST_ASSERT_UINT_WITHIN(1, (now_us() - start) / 1000u, passed);
}

/* ---- PARMRK: termios(3) ---------------------------------------------------------------------------------- */

static void marked_octets(const char *in, size_t n, const char *octets, const uint8_t *errs, size_t expected)
{
    uint8_t state = 0;
    size_t at = 0;

    for (size_t i = 0; i < n; i++) {
        uint8_t octet, err;

        if (!line_unmark(&state, (uint8_t)in[i], &octet, &err))
            continue;
        TEST_ASSERT_TRUE(at < expected);
        TEST_ASSERT_EQUAL_HEX8(octets[at], octet);
        TEST_ASSERT_EQUAL_HEX8(errs[at], err);
        at++;
    }
    TEST_ASSERT_EQUAL(expected, at);
    TEST_ASSERT_EQUAL(0, state);
}

static void parmrk_tells_good_octets_from_wrong_ones(void)
{
    static const uint8_t errs[] = {0, 0, HAL_ERR_PARITY, HAL_ERR_PARITY, HAL_ERR_FRAMING | HAL_ERR_BREAK,
                                   0, 0};

    /*             10 | FF     | A2 wrong    | FF wrong     | break        | 00 | 16 */
    marked_octets("\x10\xFF\xFF\xFF\x00\xA2\xFF\x00\xFF\xFF\x00\x00\x00\x16", 14,
                  "\x10\xFF\xA2\xFF\x00\x00\x16", errs, 7);
}

/* ---- non-volatile memory --------------------------------------------------------------------------------- */

static char nv_path[80];

static void erased_octets_read_ff_and_written_ones_come_back(void)
{
    TEST_ASSERT_NULL(nv_file_open(nv_path));
    TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(0));
    TEST_ASSERT_TRUE(hal_nv_write(0, 0x42));
    TEST_ASSERT_TRUE(hal_nv_write(HAL_NV_SIZE - 1, 7));
    TEST_ASSERT_NULL(nv_file_open(nv_path)); /* next power-up */
    TEST_ASSERT_EQUAL_HEX8(0x42, hal_nv_read(0));
    TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(1));
    TEST_ASSERT_EQUAL_HEX8(7, hal_nv_read(HAL_NV_SIZE - 1));
}

static void nv_that_cannot_be_stored_is_said_and_not_taken(void)
{
    TEST_ASSERT_NULL(nv_file_open(nv_path));
    TEST_ASSERT_TRUE(hal_nv_write(3, 1));
    unlink(nv_path);
    strcat(nv_path, ".new");
    TEST_ASSERT_EQUAL(0, mkdir(nv_path, 0700)); /* the new content cannot be written beside the old */
    TEST_ASSERT_FALSE(hal_nv_write(3, 2));
    TEST_ASSERT_EQUAL_HEX8(1, hal_nv_read(3));
    rmdir(nv_path);
    *strrchr(nv_path, '.') = '\0';
}

static void a_file_of_something_else_is_refused(void)
{
    char other[96];
    FILE *f;

    snprintf(other, sizeof other, "%s/other", folder);
    f = fopen(other, "w");
    TEST_ASSERT_NOT_NULL(f);
    fputs("somebody's letter, longer than 16 octets", f);
    fclose(f);
    TEST_ASSERT_NOT_NULL(nv_file_open(other));
    TEST_ASSERT_NOT_NULL(nv_file_open(folder));
    TEST_ASSERT_NOT_NULL(nv_file_open("/nonexistent/folder/nv"));
    TEST_ASSERT_NOT_NULL(nv_file_open(""));
    TEST_ASSERT_NULL(nv_file_open(NULL));
    unlink(other);
}

static void clean_up(void)
{
    unlink(nv_path);
    rmdir(folder);
}

int main(void)
{
    struct hal_host host = {.line = pty_spec, .switches = 42};
    const char *wrong;
    int failures;

    UNITY_BEGIN();
    if (!mkdtemp(folder))
        return 1;
    atexit(clean_up); /* runs after the port has removed its link */
    snprintf(link_path, sizeof link_path, "%s/line", folder);
    snprintf(pty_spec, sizeof pty_spec, "pty:%s", link_path);
    snprintf(nv_path, sizeof nv_path, "%s/nv", folder);
    wrong = hal_host_open(&host);
    if (wrong) {
        puts(wrong);
        return 1;
    }
    hal_init();
    RUN_TEST(octets_come_in_order_every_value_without_error);
    RUN_TEST(nothing_is_called_while_masked);
    RUN_TEST(a_run_is_sent_whole_and_then_reported_once);
    RUN_TEST(with_the_loop_octets_come_back_and_nothing_reaches_the_line);
    RUN_TEST(a_master_that_never_reads_does_not_stop_the_station);
    RUN_TEST(silence_is_called_once_and_not_before_its_time);
    RUN_TEST(silence_that_has_been_long_enough_is_called_at_once_but_not_inside);
    RUN_TEST(an_octet_that_has_arrived_cancels_silence_that_has_run_out);
    RUN_TEST(octets_of_one_run_have_no_silence_between_them);
    RUN_TEST(a_pty_has_been_silent_before_it_was_opened);
    RUN_TEST(no_limit_no_call);
    RUN_TEST(an_answer_after_silence_reaches_the_master);
    RUN_TEST(what_is_sent_to_nobody_is_lost_and_reported_as_sent);
    RUN_TEST(each_of_a_hundred_masters_is_served);
    RUN_TEST(a_new_master_does_not_read_what_an_old_one_left);
    RUN_TEST(what_a_master_said_before_it_went_is_heard);
    RUN_TEST(each_master_can_set_8e1_again);
    RUN_TEST(idle_takes_hardly_any_processor_time_with_and_without_a_master);
    RUN_TEST(bit_times_are_rounded_up_and_saturate);
    RUN_TEST(a_rate_of_nothing_is_refused_and_changes_nothing);
    RUN_TEST(ticks_are_milliseconds);
    RUN_TEST(parmrk_tells_good_octets_from_wrong_ones);
    RUN_TEST(erased_octets_read_ff_and_written_ones_come_back);
    RUN_TEST(nv_that_cannot_be_stored_is_said_and_not_taken);
    RUN_TEST(a_file_of_something_else_is_refused);
    failures = UNITY_END();
    return failures != 0;
}
