/* Ctrl-C of a class 1 master on a terminal. */
#include "sim/master.h"

#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

static struct termios before;
static char interrupt_key; /* 0: it is a signal */

static void keys_off(void)
{
    tcsetattr(STDIN_FILENO, TCSANOW, &before);
}

void master_keys(void)
{
    if (tcgetpgrp(STDIN_FILENO) != getpgrp() || tcgetattr(STDIN_FILENO, &before) != 0)
        return;
    struct termios ours = before;
    if (ours.c_cc[VINTR] == _POSIX_VDISABLE)
        return;
    ours.c_lflag &= (tcflag_t)~ISIG;
    ours.c_cc[VEOL] = ours.c_cc[VINTR];
    if (tcsetattr(STDIN_FILENO, TCSANOW, &ours) == 0 && atexit(keys_off) == 0)
        interrupt_key = (char)ours.c_cc[VINTR];
}

bool master_interrupted(const char *text, size_t n)
{
    return interrupt_key && memchr(text, interrupt_key, n) != NULL;
}
