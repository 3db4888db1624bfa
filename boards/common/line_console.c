#include "line_console.h"
#include "hal/hal.h"

uint8_t XDATA console_line[CONSOLE_LINE + 1u];
static uint8_t len;
static bool too_long;

void console_say(const char CODE *text)
{
    while (*text)
        hal_con_put((uint8_t)*text++);
}

/* Digits are made from the lowest up. */
void console_say_pair(const char CODE *key, uint16_t value)
{
    static uint8_t XDATA digits[5];
    uint8_t n = 0;

    console_say(key);
    do {
        digits[n++] = (uint8_t)('0' + value % 10u);
        value /= 10u;
    } while (value);
    while (n)
        hal_con_put(digits[--n]);
}

void console_end(void)
{
    console_say("\r\n");
}

uint16_t console_number(uint8_t XDATA *at)
{
    uint16_t n = 0;
    uint8_t i = *at;

    if (console_line[i] < '0' || console_line[i] > '9')
        return CONSOLE_NO_NUMBER;
    while (console_line[i] >= '0' && console_line[i] <= '9' && n < 1000u)
        n = (uint16_t)(n * 10u + (console_line[i++] - '0'));
    while (console_line[i] == ' ')
        i++;
    *at = i;
    return n < 1000u ? n : CONSOLE_NO_NUMBER;
}

bool console_is(const char CODE *word)
{
    uint8_t i = 0;

    while (word[i])
        if (console_line[i] != (uint8_t)word[i])
            return false;
        else
            i++;
    return console_line[i] == 0 || console_line[i] == ' ';
}

static bool end_of_line(void)
{
    bool complete;

    console_line[len] = 0;
    complete = len != 0 && !too_long;
    if (too_long) {
        console_say("error=line-too-long");
        console_end();
    }
    len = 0;
    too_long = false;
    return complete;
}

bool console_read(void)
{
    int16_t octet;

    while ((octet = hal_con_get()) >= 0) {
        if (octet == '\r' || octet == '\n') {
            if (end_of_line())
                return true;
        } else if (len < CONSOLE_LINE) {
            console_line[len++] = (uint8_t)octet;
        } else {
            too_long = true;
        }
    }
    return false;
}
