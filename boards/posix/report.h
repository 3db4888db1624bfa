/* What a program has to say, event by event: as "event=NAME key=value ..." or as one JSON object a line. */
#ifndef FIELDLING_REPORT_H
#define FIELDLING_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where lines go: standard output when sink is NULL. */
void report_to(bool json, void (*sink)(const char *line));

void report_begin(const char *event);
void report_text(const char *key, const char *text);
void report_number(const char *key, double number);
void report_flag(const char *key, bool flag);
/* Values where bit i of valid is set; "null" (json) or "-" for others. */
void report_values(const char *key, const uint16_t *values, unsigned n, uint32_t valid);
void report_list(const char *key, const uint16_t *values, unsigned n);
void report_end(void);

#endif
