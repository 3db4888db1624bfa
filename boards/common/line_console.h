/* One line in, one line of key=value out, over hal_con_get() and hal_con_put(): what the consoles of boards share.
 * Context: main. */
#ifndef LINE_CONSOLE_H
#define LINE_CONSOLE_H

#include "check.h"

#define CONSOLE_LINE 24u

/* The line that was read, ended by 0. */
extern uint8_t XDATA console_line[CONSOLE_LINE + 1u];

/* Take waiting octets. -> a line is complete; it stands in console_line until the next call. A line too long is answered
 * with an error and is not complete. */
bool console_read(void);

/* The line begins with this word. */
bool console_is(const char CODE *word);

/* An unsigned decimal word from console_line[*at] on, which is moved behind it and the blanks; CONSOLE_NO_NUMBER where
 * there is none below 1000. */
#define CONSOLE_NO_NUMBER 0xFFFFu
uint16_t console_number(uint8_t XDATA *at);

/* Text; text and a decimal number; the end of the line. */
void console_say(const char CODE *text);
void console_say_pair(const char CODE *key, uint16_t value);
void console_end(void);

#endif
