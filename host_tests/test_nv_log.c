/* nv_log.c on a page of flash that fails: programs that fail, words half written, power lost at every step.
 *
 * The page is NOR flash: programming clears bits, erasing sets them. A step that fails takes effect on some of its bits. */
#include "hal/nv_log.h"
#include "unity.h"

#define WORDS 24u
#define NEVER 0xFFFFu

const uint16_t nv_page_words = WORDS;

static struct {
    uint32_t word[WORDS];
    uint16_t programs, erases;
    uint16_t fail_at;   /* the step, counted from 0, that takes effect in part */
    bool power_fails;   /* and nothing after it has any effect */
    uint32_t effect;    /* the bits it takes effect on; of an erase, turned for each word */
    bool to_zero_first; /* an erase is stopped while it still programs everything to 0, as NOR flash does first */
    bool powered;
    uint8_t masked;
} page;

static uint32_t random_state;

static uint32_t random32(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

/* ---- the port ---- */

uint8_t hal_irq_save(void)
{
    return page.masked++;
}

void hal_irq_restore(uint8_t state)
{
    page.masked = state;
}

uint32_t nv_page_read(uint16_t n)
{
    TEST_ASSERT_TRUE(page.masked);
    TEST_ASSERT_LESS_THAN_UINT16(WORDS, n);
    return page.word[n];
}

/* -> bits this step takes effect on */
static uint32_t step(void)
{
    uint32_t bits = page.powered ? 0xFFFFFFFFu : 0;

    if (page.programs + page.erases == page.fail_at) {
        bits = page.effect;
        page.powered = !page.power_fails;
    }
    return bits;
}

bool nv_page_program(uint16_t n, uint32_t word)
{
    TEST_ASSERT_TRUE(page.masked);
    TEST_ASSERT_LESS_THAN_UINT16(WORDS, n);
    if (page.powered)
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0xFFFFFFFFu, page.word[n], "only erased words are programmed");
    page.word[n] &= word | ~step();
    page.programs++;
    return page.word[n] == word;
}

bool nv_page_erase(void)
{
    uint32_t bits = step();
    uint16_t i;
    bool good = true;

    TEST_ASSERT_TRUE(page.masked);
    for (i = 0; i < WORDS; i++) {
        if (page.to_zero_first && bits != 0xFFFFFFFFu)
            page.word[i] &= ~bits;
        else
            page.word[i] |= bits;
        good = good && page.word[i] == 0xFFFFFFFFu;
        if (bits && bits != 0xFFFFFFFFu)
            bits = random32();
    }
    page.erases++;
    return good;
}

/* ---- what the tests share ---- */

void setUp(void)
{
    uint16_t i;

    page.programs = page.erases = 0;
    page.fail_at = NEVER;
    page.power_fails = page.to_zero_first = false;
    page.powered = true;
    page.masked = 0;
    random_state = 1;
    for (i = 0; i < WORDS; i++)
        page.word[i] = 0xFFFFFFFFu;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, page.masked, "interrupts are as they were");
}

static void power_up(void)
{
    page.powered = true;
    page.fail_at = NEVER;
}

static void fail_next(uint32_t effect, bool power_fails)
{
    page.fail_at = (uint16_t)(page.programs + page.erases);
    page.effect = effect;
    page.power_fails = power_fails;
}

/* Cells 0..3 hold 10 11 12 13 and then cell 0 counts, until the page has `left` erased words. */
static uint8_t fill(uint16_t left)
{
    uint8_t value = 0x10;
    uint8_t i;

    for (i = 0; i < 4; i++)
        TEST_ASSERT_TRUE(hal_nv_write(i, (uint8_t)(0x10 + i)));
    while (page.programs < WORDS - left)
        TEST_ASSERT_TRUE(hal_nv_write(0, ++value));
    return value;
}

/* Whatever the page has been through, it serves. */
static void serves(void)
{
    uint8_t cells[HAL_NV_SIZE];
    uint8_t i;
    uint16_t n;

    for (i = 0; i < HAL_NV_SIZE; i++)
        cells[i] = hal_nv_read(i);
    for (n = 0; n < 3 * WORDS; n++) {
        uint8_t index = (uint8_t)(random32() % HAL_NV_SIZE);
        uint8_t value = (uint8_t)random32();

        TEST_ASSERT_TRUE(hal_nv_write(index, value));
        cells[index] = value;
        for (i = 0; i < HAL_NV_SIZE; i++)
            TEST_ASSERT_EQUAL_HEX8(cells[i], hal_nv_read(i));
    }
}

/* ---- a page that works ---- */

static void test_cells_of_an_erased_page_read_FF(void)
{
    uint8_t i;

    for (i = 0; i < HAL_NV_SIZE; i++)
        TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(i));
    TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(HAL_NV_SIZE));
    TEST_ASSERT_FALSE(hal_nv_write(HAL_NV_SIZE, 0));
    TEST_ASSERT_EQUAL_UINT16(0, page.programs);
}

static void test_a_word_is_index_value_and_their_complements(void)
{
    TEST_ASSERT_TRUE(hal_nv_write(3, 0x58));
    TEST_ASSERT_EQUAL_HEX32(0xFCA75803u, page.word[0]);
    TEST_ASSERT_EQUAL_HEX8(0x58, hal_nv_read(3));
}

static void test_a_page_is_delivered_with_words_in_it(void)
{
    page.word[0] = NV_LOG_WORD(0, 3);
    TEST_ASSERT_EQUAL_HEX32(0xFFFC0300u, page.word[0]);
    TEST_ASSERT_EQUAL_HEX8(3, hal_nv_read(0));
}

static void test_a_change_costs_one_word_and_no_change_none(void)
{
    TEST_ASSERT_TRUE(hal_nv_write(1, 7));
    TEST_ASSERT_TRUE(hal_nv_write(1, 7));
    TEST_ASSERT_TRUE(hal_nv_write(2, 0xFF));
    TEST_ASSERT_EQUAL_UINT16(1, page.programs);
    TEST_ASSERT_TRUE(hal_nv_write(1, 0xFF));
    TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(1));
    TEST_ASSERT_EQUAL_UINT16(2, page.programs);
}

static void test_only_a_full_page_is_erased_and_every_cell_lives_on(void)
{
    uint8_t last = fill(0);

    TEST_ASSERT_EQUAL_UINT16(0, page.erases);
    TEST_ASSERT_TRUE(hal_nv_write(2, 0x77));
    TEST_ASSERT_EQUAL_UINT16(1, page.erases);
    TEST_ASSERT_EQUAL_HEX8(last, hal_nv_read(0));
    TEST_ASSERT_EQUAL_HEX8(0x11, hal_nv_read(1));
    TEST_ASSERT_EQUAL_HEX8(0x77, hal_nv_read(2));
    TEST_ASSERT_EQUAL_HEX8(0x13, hal_nv_read(3));
    serves();
}

/* ---- a page that fails ---- */

static void test_a_word_stopped_at_any_of_its_bits_is_the_old_value_or_the_new_one(void)
{
    static const uint32_t octets[] = {0, 0xFF, 0xFFFF, 0xFF0000, 0xFFFF0000, 0xFFFFFF};
    const uint32_t word = NV_LOG_WORD(2, 0x5A);
    uint32_t kept = 0;
    uint16_t i;

    TEST_ASSERT_TRUE(hal_nv_write(2, 0x33));
    TEST_ASSERT_TRUE(hal_nv_write(3, 0x44));
    page.masked = 1;
    do { /* every set of bits that are 0 in the word and have stayed 1 */
        page.word[2] = word | kept;
        TEST_ASSERT_EQUAL_HEX8(kept ? 0x33 : 0x5A, hal_nv_read(2));
        TEST_ASSERT_EQUAL_HEX8(0x44, hal_nv_read(3));
        kept = (kept - ~word) & ~word;
    } while (kept);
    page.masked = 0;
    for (i = 0; i < sizeof octets / sizeof octets[0]; i++) {
        setUp();
        TEST_ASSERT_TRUE(hal_nv_write(2, 0x33));
        fail_next(octets[i], true);
        TEST_ASSERT_FALSE(hal_nv_write(2, 0x5A));
        power_up();
        TEST_ASSERT_EQUAL_HEX8(0x33, hal_nv_read(2));
        TEST_ASSERT_TRUE(hal_nv_write(2, 0x5A));
        serves();
    }
}

static void test_a_program_that_fails_is_said_and_the_next_write_works(void)
{
    uint32_t effect;

    for (effect = 0; effect < 0xFFFFFFu; effect = effect * 2 + 1) {
        setUp();
        TEST_ASSERT_TRUE(hal_nv_write(5, 1));
        fail_next(effect & 0x00FF0000u, false);
        TEST_ASSERT_FALSE(hal_nv_write(5, 0x0F));
        TEST_ASSERT_EQUAL_HEX8(1, hal_nv_read(5));
        TEST_ASSERT_TRUE(hal_nv_write(5, 0x0F));
        serves();
    }
}

static void test_an_erase_that_fails_without_effect_keeps_every_cell(void)
{
    uint8_t last = fill(0);

    fail_next(0, false);
    TEST_ASSERT_FALSE(hal_nv_write(2, 0x77));
    TEST_ASSERT_EQUAL_HEX8(last, hal_nv_read(0));
    TEST_ASSERT_EQUAL_HEX8(0x12, hal_nv_read(2));
    TEST_ASSERT_TRUE(hal_nv_write(2, 0x77));
    serves();
}

static void test_a_word_that_fails_in_a_renewed_page_costs_its_own_cell_only(void)
{
    uint8_t last = fill(0);

    fail_next(0, false);
    page.fail_at++; /* not the erase, the first word behind it: cell 0 */
    TEST_ASSERT_FALSE(hal_nv_write(2, 0x77));
    TEST_ASSERT_NOT_EQUAL_UINT8(last, hal_nv_read(0));
    TEST_ASSERT_EQUAL_HEX8(0x11, hal_nv_read(1));
    TEST_ASSERT_EQUAL_HEX8(0x12, hal_nv_read(2));
    TEST_ASSERT_EQUAL_HEX8(0x13, hal_nv_read(3));
    serves();
}

/* A full page takes erase, four words, and the new one: steps 0 to 5. */
static void power_lost_while_renewed(uint16_t at, uint32_t effect, bool to_zero_first)
{
    uint8_t last, i;

    setUp();
    random_state = effect | 1u;
    last = fill(0);
    fail_next(effect, true);
    page.fail_at = (uint16_t)(page.fail_at + at);
    page.to_zero_first = to_zero_first;
    hal_nv_write(2, 0x77);
    power_up();
    if (hal_nv_read(0) != 0xFF)
        TEST_ASSERT_TRUE(hal_nv_read(0) >= 0x10 && hal_nv_read(0) <= last);
    for (i = 1; i < 4; i++)
        if (hal_nv_read(i) != 0xFF)
            TEST_ASSERT_TRUE(hal_nv_read(i) == 0x10 + i || (i == 2 && hal_nv_read(i) == 0x77));
    for (i = 4; i < HAL_NV_SIZE; i++)
        TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(i));
    if (at == 5)
        TEST_ASSERT_TRUE(hal_nv_read(0) == last && hal_nv_read(1) == 0x11 && hal_nv_read(2) != 0xFF &&
                         hal_nv_read(3) == 0x13);
    serves();
}

static void test_power_lost_at_each_step_of_renewing_invents_no_value(void)
{
    uint16_t at, n;
    uint32_t effects = 12345;

    for (at = 0; at <= 5; at++)
        for (n = 0; n < 200; n++) {
            effects = effects * 1664525u + 1013904223u;
            power_lost_while_renewed(at, effects, n & 1);
        }
}

/* What an erase can leave: words of the old log behind erased ones. */
static void test_old_words_behind_erased_ones_do_not_come_back(void)
{
    page.word[5] = NV_LOG_WORD(1, 0x21);
    TEST_ASSERT_TRUE(hal_nv_write(1, 0x22));
    serves();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cells_of_an_erased_page_read_FF);
    RUN_TEST(test_a_word_is_index_value_and_their_complements);
    RUN_TEST(test_a_page_is_delivered_with_words_in_it);
    RUN_TEST(test_a_change_costs_one_word_and_no_change_none);
    RUN_TEST(test_only_a_full_page_is_erased_and_every_cell_lives_on);
    RUN_TEST(test_a_word_stopped_at_any_of_its_bits_is_the_old_value_or_the_new_one);
    RUN_TEST(test_a_program_that_fails_is_said_and_the_next_write_works);
    RUN_TEST(test_an_erase_that_fails_without_effect_keeps_every_cell);
    RUN_TEST(test_a_word_that_fails_in_a_renewed_page_costs_its_own_cell_only);
    RUN_TEST(test_power_lost_at_each_step_of_renewing_invents_no_value);
    RUN_TEST(test_old_words_behind_erased_ones_do_not_come_back);
    return UNITY_END();
}
