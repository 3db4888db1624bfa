/* The line: serial port and Timer 2. What a character looks like is said by chunk.c or octet.c.
 *
 * The core shows neither a wrong stop bit nor a lost octet; what they do to a telegram its checks find.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

#define T2CON_BAUD 0x34u /* receive and transmit clock from Timer 2, running */

/* Below this an octet leaves so little time that the service stays until the telegram is over. */
#define BURST_OCTET_CYCLES 100u
/* Below this it waits for the octets of a short chunk: to be interrupted by each would take as long. */
#define WAIT_OCTET_CYCLES 200u
#define FEW               5u
/* Below this an interrupt an octet would leave gaps: the service stays until all are sent. */
#ifndef POLLED_BIT_CYCLES
#define POLLED_BIT_CYCLES 80u
#endif
/* our choice: what a UART on the other side bears with its own share, PROFIBUS and Modbus alike. */
#define MAX_ERROR_PERCENT 1u

volatile __bit sending;
volatile __bit burst;
volatile __bit hear;
HOT uint8_t few;

static volatile __bit polled;
static const uint8_t XDATA *HOT tx_at;
static HOT uint8_t tx_low;  /* octets left, with the one on the line: low octet, and high one that counts */
static HOT uint8_t tx_high; /* the begun 256 as a whole: both are counted down by djnz                    */
static HOT uint8_t stop_bit_low; /* Timer 0 a bit time before its overflow */
static HOT uint8_t stop_bit_high;
static uint16_t bit_cycles; /* a bit lasts bit_cycles + bit_thirds / 3 machine cycles */
static uint8_t bit_thirds;

/* ---- send ------------------------------------------------------------------------------------------------------------------- */

/* octets come in dptr. In assembly because the master waits for the first one. Where an interrupt an octet would leave gaps
 * it returns when all are out. */
void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR __naked
{
    octets, n;
    __asm
        clr _TI
        setb _sending
    __endasm;
    DRIVER_ON();
    __asm
        movx a,@dptr
        lcall _ninth_isr
        mov _SBUF,a
        clr _REN
        clr _TR0
        clr _TF0
        clr _hear
        clr _due
        inc dptr
        mov _tx_at,dpl
        mov (_tx_at + 1),dph
        mov dptr,#_hal_send_PARM_2
        movx a,@dptr
        mov _tx_low,a
        jz 00001$
        mov a,#1
    00001$:
        mov _tx_high,a
        inc dptr
        movx a,@dptr
        add a,_tx_high
        mov _tx_high,a
        jnb _polled,00002$
        clr _ES
        lcall _send_polled_isr
        setb _IE1
    00002$:
        ret
    __endasm;
}

/* After the last octet Timer 0 waits for its stop bit: TI comes with its beginning (in some cores at its end). */
void send_next_isr(void) __naked
{
    __asm
        jnb _TI,00003$
        clr _TI
        jnb _sending,00003$
        push psw
        push acc
        push dpl
        push dph
        djnz _tx_low,00001$
        djnz _tx_high,00001$
        mov _TL0,_stop_bit_low
        mov _TH0,_stop_bit_high
        setb _ET0
        setb _TR0
        sjmp 00002$
    00001$:
        mov dpl,_tx_at
        mov dph,(_tx_at + 1)
        movx a,@dptr
        lcall _ninth_isr
        mov _SBUF,a
        inc dptr
        mov _tx_at,dpl
        mov (_tx_at + 1),dph
    00002$:
        pop dph
        pop dpl
        pop acc
        pop psw
    00003$:
        reti
    __endasm;
}

/* All octets, each of them ready when TI comes, and the last stop bit. */
static void send_polled_isr(void) IN_ISR __naked
{
    __asm
        mov dpl,_tx_at
        mov dph,(_tx_at + 1)
        sjmp 00003$
    00001$:
        movx a,@dptr
        inc dptr
        lcall _ninth_isr        ; the character on the line has its own already
    00002$:
        jnb _TI,00002$
        mov _SBUF,a
        clr _TI
    00003$:
        djnz _tx_low,00001$
        djnz _tx_high,00001$
    00004$:
        jnb _TI,00004$
        clr _TI
        mov a,_stop_bit_low
    00005$:
        add a,#4                ; cycles a turn
        jnc 00005$
    __endasm;
    DRIVER_OFF();
    __asm
        ljmp _silence_restart_isr
    __endasm;
}

void sent_isr(void) IN_ISR
{
    if (!polled) {
        if (!due)
            return;
        DRIVER_OFF();
        silence_restart_isr();
    }
    sending = 0;
    receive_off_isr();
    RI = 0;
    REN = 1;
    ES = 1;
    line_sent_isr();
}

/* ---- open ------------------------------------------------------------------------------------------------------------------- */

/* N of Timer 2 for the rate, 0 where the error is too large. By additions: a division would cost 350 octets of code. */
#define RATE_AT_1 (FOSC_HZ / 32u)
#define TOLERANCE (RATE_AT_1 / 100u * MAX_ERROR_PERCENT)
static uint16_t divisor(uint32_t bit_per_s)
{
    uint32_t sum = 0; /* n * bit_per_s */
    uint16_t n = 0;

    while (sum < RATE_AT_1 - TOLERANCE) {
        sum += bit_per_s;
        if (++n == 0)
            return 0;
    }
    return sum <= RATE_AT_1 + TOLERANCE ? n : 0;
}

/* A time in machine cycles and thirds of one; it saturates. */
static uint16_t cycles;
static uint8_t thirds;

static void add(uint16_t more_cycles, uint8_t more_thirds)
{
    thirds = (uint8_t)(thirds + more_thirds);
    if (thirds >= 3) {
        thirds = (uint8_t)(thirds - 3u);
        if (++more_cycles == 0)
            more_cycles = 0xFFFFu;
    }
    cycles = (uint16_t)(cycles + more_cycles);
    if (cycles < more_cycles)
        cycles = 0xFFFFu;
}

/* n bit times, from the highest bit of n on. */
static void bit_times(uint16_t n)
{
    uint8_t i;

    cycles = 0;
    thirds = 0;
    for (i = 16; i; i--) {
        add(cycles, thirds);
        if (n & 0x8000u)
            add(bit_cycles, bit_thirds);
        n = (uint16_t)(n << 1);
    }
}

hal_dur_t hal_tbit(uint16_t n)
{
    bit_times(n);
    if (thirds)
        add(0, (uint8_t)(3u - thirds));
    return cycles;
}

/* 8 N / 3 machine cycles: N times 2 and two thirds */
static void set_bit_time(uint16_t n)
{
    bit_cycles = 2;
    bit_thirds = 2;
    bit_times(n);
    bit_cycles = cycles;
    bit_thirds = thirds;
    stop_bit_low = (uint8_t)(0u - bit_cycles);
    stop_bit_high = (uint8_t)((0u - bit_cycles) >> 8);
    polled = bit_cycles < POLLED_BIT_CYCLES;
    burst = hal_tbit(11) < BURST_OCTET_CYCLES;
    few = hal_tbit(11) >= WAIT_OCTET_CYCLES ? 0 : burst ? 255 : FEW;
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    uint16_t n = bit_per_s ? divisor(bit_per_s) : 0;
    uint8_t irq = hal_irq_save();

    if (!receive_open(n, format)) {
        hal_irq_restore(irq);
        return HAL_LINE_NO;
    }
    ES = 0;
    ET0 = 0;
    DRIVER_OFF();
    sending = 0;
    receive_off_isr();
    set_bit_time(n);
    T2CON = 0;
    n = (uint16_t)(0u - n);
    RCAP2L = (uint8_t)n;
    RCAP2H = (uint8_t)(n >> 8);
    TL2 = RCAP2L;
    TH2 = RCAP2H;
    T2CON = T2CON_BAUD;
    silence_open_isr();
    REN = 1;
    ES = 1;
    hal_irq_restore(irq);
    return HAL_LINE_TIMED;
}
