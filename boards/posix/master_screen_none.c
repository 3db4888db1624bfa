#include "master_screen.h"

const char *screen_open(void)
{
    return "built without a screen (no ncurses headers were there); use --batch SECONDS, with --json if you like";
}

void screen_draw(const struct hp *p, double load, uint64_t now_ms)
{
    (void)p;
    (void)load;
    (void)now_ms;
}

void screen_log(const char *line)
{
    (void)line;
}

const char *screen_key(int key, bool *quit)
{
    (void)key;
    (void)quit;
    return NULL;
}
