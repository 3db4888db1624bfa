#include "mb_image.h"
#include "options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCKS   1024u
#define FIFO_MAX 31u
#define TEXT_MAX 249u
#define WORDS    4096u

static struct mb_block blocks[BLOCKS + 1u];
static unsigned blocks_n;
static uint8_t id;
static char id_text[TEXT_MAX + 1u] = "Fieldling";
static char *words[WORDS];
static unsigned words_n;
static bool bad_number;

static bool is_bits(uint8_t table)
{
    return table <= MB_INPUTS;
}

static uint32_t number(unsigned word, uint32_t max)
{
    uint32_t value = 0;
    if (word >= words_n || !option_number(words[word], 0, max, &value))
        bad_number = true;
    return value;
}

static void put(const struct mb_block *b, uint32_t i, uint32_t value)
{
    if (!is_bits(b->table))
        ((uint16_t *)b->data)[i] = (uint16_t)value;
    else if (value)
        ((uint8_t *)b->data)[i / 8u] |= (uint8_t)(1u << i % 8u);
}

static bool overlaps(const struct mb_block *b)
{
    for (unsigned i = 0; i < blocks_n; i++) {
        const struct mb_block *o = &blocks[i];
        if (o->table == b->table &&
            (b->table == MB_FILE ? o->first == b->first
                                 : b->first < o->first + o->count && o->first < b->first + b->count))
            return true;
    }
    return false;
}

/* A block with zeros. -> NULL, or what is wrong. */
static const char *add(uint8_t table, uint32_t first, uint32_t count)
{
    struct mb_block *b = &blocks[blocks_n];
    if (bad_number)
        return "a number is missing or out of range";
    if (count == 0 || (table != MB_FILE && first + count > 0x10000u))
        return "no such addresses";
    if (blocks_n == BLOCKS)
        return "too many blocks";
    b->table = table;
    b->first = (uint16_t)first;
    b->count = (uint16_t)count;
    if (overlaps(b))
        return "overlaps an earlier line";
    b->data = calloc(count, sizeof(uint16_t));
    if (!b->data)
        return "out of memory";
    blocks_n++;
    return NULL;
}

/* What follows TABLE START COUNT, from word 3 on. */
static const char *fill(const struct mb_block *b)
{
    const uint32_t base = b->table == MB_FILE ? 0 : b->first;
    const char *const how = words_n > 3 ? words[3] : "";
    if (is_bits(b->table) && strcmp(how, "every") == 0) {
        const uint32_t n = number(4, 0xFFFF);
        if (words_n != 5 || n == 0)
            return "every N";
        for (uint32_t i = 0; i < b->count; i++)
            put(b, i, (base + i) % n == 0);
    } else if (!is_bits(b->table) && strcmp(how, "linear") == 0) {
        const uint32_t slope = number(4, 0xFFFF), start = number(5, 0xFFFF);
        if (words_n != 6)
            return "linear A B";
        for (uint32_t i = 0; i < b->count; i++)
            put(b, i, slope * (base + i) + start);
    } else {
        if (words_n - 3u > b->count)
            return "more values than COUNT";
        for (uint32_t i = 0; i + 3u < words_n; i++)
            put(b, i, number(i + 3u, is_bits(b->table) ? 1 : 0xFFFF));
    }
    return bad_number ? "a number is missing or out of range" : NULL;
}

static const char *take_fifo(void)
{
    const char *wrong;
    if (words_n > 2u + FIFO_MAX)
        return "more than 31 values";
    wrong = add(MB_FIFO, number(1, 0xFFFF - FIFO_MAX), 1u + FIFO_MAX);
    if (wrong)
        return wrong;
    put(&blocks[blocks_n - 1u], 0, words_n - 2u);
    for (uint32_t i = 2; i < words_n; i++)
        put(&blocks[blocks_n - 1u], i - 1u, number(i, 0xFFFF));
    return bad_number ? "a number is out of range" : NULL;
}

/* rest: the line behind the word server-id, as it was written. */
static const char *take_server_id(const char *rest)
{
    uint32_t value = 0;
    if (words_n > 2 && option_number(words[1], 0, 255, &value))
        rest += strcspn(rest, " \t") + strspn(rest + strcspn(rest, " \t"), " \t");
    if (strlen(rest) > TEXT_MAX)
        return "more than 249 characters";
    id = (uint8_t)value;
    strcpy(id_text, rest);
    return NULL;
}

static const char *take_line(const char *rest)
{
    static const struct {
        const char *word;
        uint8_t table;
    } tables[] = {{"coils", MB_COILS},
                  {"inputs", MB_INPUTS},
                  {"input-regs", MB_INPUT_REGS},
                  {"holding-regs", MB_HOLDING},
                  {"file", MB_FILE}};
    const char *wrong;
    bad_number = false;
    if (strcmp(words[0], "server-id") == 0)
        return take_server_id(rest);
    if (strcmp(words[0], "fifo") == 0)
        return take_fifo();
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        if (strcmp(words[0], tables[i].word) != 0)
            continue;
        wrong = add(tables[i].table, number(1, 0xFFFF), number(2, 0xFFFF));
        return wrong ? wrong : fill(&blocks[blocks_n - 1u]);
    }
    return "expected coils, inputs, input-regs, holding-regs, file, fifo or server-id";
}

static void split(char *line)
{
    words_n = 0;
    for (char *word = strtok(line, " \t"); word && words_n < WORDS; word = strtok(NULL, " \t"))
        words[words_n++] = word;
}

const char *mb_image_read(const char *path)
{
    static char text[512];
    static char line[32768], copy[sizeof line];
    FILE *f = fopen(path, "r");
    const char *wrong = NULL;
    unsigned n = 0;
    if (!f) {
        snprintf(text, sizeof text, "%s: %s", path, strerror(errno));
        return text;
    }
    while (!wrong && fgets(line, sizeof line, f)) {
        n++;
        line[strcspn(line, "#\r\n")] = 0;
        strcpy(copy, line);
        split(line);
        if (words_n != 0) {
            const char *rest = copy + strspn(copy, " \t") + strlen(words[0]);
            wrong = take_line(rest + strspn(rest, " \t"));
        }
    }
    fclose(f);
    if (!wrong)
        return NULL;
    snprintf(text, sizeof text, "%s:%u: %s", path, n, wrong);
    return text;
}

const struct mb_block *mb_image_blocks(void)
{
    return blocks;
}

uint8_t mb_image_server_id(uint8_t *octets)
{
    octets[0] = id;
    octets[1] = 0xFF;
    memcpy(octets + 2, id_text, strlen(id_text));
    return (uint8_t)(2u + strlen(id_text));
}
