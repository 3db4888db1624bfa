/* TI's <stdint.h> for the C28x has no 8-bit types, for the CPU has none: a char has 16 bits. Before all else in every file
 * (--preinclude=octets.h). What then still has to be done is in boards/f2808/README.md. */
#ifndef F2808_OCTETS_H
#define F2808_OCTETS_H

#include <stdint.h>

typedef uint_least8_t uint8_t;
typedef int_least8_t int8_t;

#endif
