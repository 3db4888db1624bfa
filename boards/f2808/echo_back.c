/* Set-up and texts: spec B8. The rate is that of LSPCLK 25 MHz: 25 MHz / ((144H + 1) * 8) = 9615 bit/s. */
#include "echo_back.h"
#include "check.h"
#include "hal/f2808/f2808.h"

static void set_up(void)
{
    reg_set(SCICCR, 0x0007);
    reg_set(SCICTL1, 0x0003);
    reg_set(SCICTL2, 0x0003);
    reg_set(SCIHBAUD, 0x0001);
    reg_set(SCILBAUD, 0x0044);
    reg_set(SCICTL1, 0x0023);
    reg_set(SCIFFTX, 0xE040);
    reg_set(SCIFFRX, 0x204F);
    reg_set(SCIFFCT, 0x0000);
}

static void put(char c)
{
    while (FIFO_COUNT(reg_get(SCIFFTX)) != 0) {
    }
    reg_set(SCITXBUF, (uint16_t)(c & 0xFF));
}

static void say(const char *text)
{
    while (*text)
        put(*text++);
}

void echo_back_begin(void)
{
    set_up();
    say("\r\nHello World!");
    say("\r\nYou will enter a character, and the DSP will echo it back!\r\n");
}

void echo_back_one(void)
{
    char c;

    say("\r\nEnter a character: ");
    while (FIFO_COUNT(reg_get(SCIFFRX)) == 0) {
    }
    c = (char)(reg_get(SCIRXBUF) & 0xFFu);
    say(" You sent: ");
    put(c);
}
