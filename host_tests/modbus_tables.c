/* Prints the tables of firmware/modbus/README.md from what the code is built from: functions, inverter
 * registers. */
#include "boards/common/inverter_map.h"
#include "modbus/mb.h"

#include <stdio.h>

static const char *broadcast(unsigned how)
{
    return how & MB_BROADCAST ? "yes" : "";
}

static unsigned at;

int main(void)
{
    puts("<!-- functions -->");
    puts("| code | handler | request octets | broadcast |");
    puts("|---|---|---|---|");
#define FUNCTION(code, handler, octets, how)                                                                 \
    printf("| %u (%02XH) | `%s` | %u%s | %s |\n", code, code, #handler, octets,                              \
           ((how)&3u) == MB_COUNTED ? " + count"                                                             \
           : ((how)&3u) == MB_LEAST ? " or more"                                                             \
                                    : "",                                                                    \
           broadcast(how));
    MB_FUNCTIONS(FUNCTION)
    puts("<!-- end -->");
    puts("<!-- inverter -->");
    puts("| address | name | unit | range | default | |");
    puts("|---|---|---|---|---|---|");
    puts("| | **coils** (01, 05, 15) | | | | |");
#define COIL(name, text) printf("| %u | %s | | 0, 1 | 0 | %s |\n", at++, #name, text);
    INV_COILS(COIL)
    at = 0;
    puts("| | **discrete inputs** (02) | | | | |");
#define INPUT(name, text) printf("| %u | %s | | 0, 1 | | %s |\n", at++, #name, text);
    INV_INPUTS(INPUT)
    at = 0;
    puts("| | **holding registers** (03, 06, 16, 22, 23) | | | | |");
#define PARAM(name, unit, min, max, value, saved, text)                                                      \
    printf("| %u | %s | %s | %u..%u | %u | %s%s |\n", at++, #name, unit, min, max, value, text,              \
           (saved) ? "; kept by STORE" : "");
    INV_PARAMS(PARAM)
    at = 0;
    puts("| | **input registers** (04) | | | | |");
#define VALUE(name, unit, text) printf("| %u | %s | %s | | | %s |\n", at++, #name, unit, text);
    INV_VALUES(VALUE)
    puts("| | **others** | | | | |");
    printf("| %u | trip history | | | | function 24: the last %u trip codes, newest first |\n", INV_TRIP_FIFO,
           INV_TRIPS_KEPT);
    printf("| file %u | trend | 0.01 Hz | | | function 20: %u records, output frequency every 100 ms, newest "
           "first |\n",
           INV_FILE_TREND, INV_TREND_KEPT);
    printf("| file %u | note | | | | functions 20, 21: %u records for the owner |\n", INV_FILE_NOTE,
           INV_NOTE_RECORDS);
    puts("<!-- end -->");
    return 0;
}
