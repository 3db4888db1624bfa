/* The main() around a module test's own on the simulated 8052: serial port on, the test, and power down, at which the
 * simulator stops. The test's main() is compiled as test_main(). */
#include <8052.h>

void test_main(void);

void s51_put(int octet)
{
    SBUF = (unsigned char)octet;
    while (!TI) {
    }
    TI = 0;
}

unsigned char _sdcc_external_startup(void)
{
    SCON = 0x40; /* mode 1, the receiver off          */
    TMOD = 0x20; /* timer 1, mode 2, as fast as it is */
    PCON = 0x80;
    TH1 = 0xFF;
    TR1 = 1;
    return 0;
}

void main(void)
{
    test_main();
    PCON = 0x02;
    for (;;) {
    }
}
