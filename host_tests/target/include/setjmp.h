/* For machines without a library: what Unity needs. */
#ifndef TARGET_SETJMP_H
#define TARGET_SETJMP_H

typedef void *jmp_buf[5];
#define setjmp(buf)         __builtin_setjmp(buf)
#define longjmp(buf, value) __builtin_longjmp(buf, value)

#endif
