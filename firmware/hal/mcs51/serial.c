/* The line: serial port and Timer 2.
 *
 * Where the bits go. Mode 3 has nine bits a character, the ninth in TB8 and RB8; mode 1 has eight.
 *   8E1, 8O1  mode 3, parity ninth            7E1, 7O1  mode 1, parity eighth
 *   8N2       mode 3, ninth 1 = a stop bit    7N2       mode 1, eighth 1 = a stop bit        8N1  mode 1
 * The core shows neither a wrong stop bit nor a lost octet; what they do to a telegram its checks find.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

#define SCON_MODE_3 0xC0u
#define SCON_MODE_1 0x40u
#define SCON_REN    0x10u
#define T2CON_BAUD  0x34u /* receive and transmit clock from Timer 2, running */

/* Below this an interrupt for each octet takes nearly all of the time there is: stay until the telegram is over. */
#define BURST_OCTET_CYCLES 150u
/* Below this the receiver of the stack cannot follow; of DP: 100 cycles are 110 kbit/s at 12 MHz. */
#ifndef MIN_OCTET_CYCLES
#define MIN_OCTET_CYCLES 100u
#endif
#define MIN_N (MIN_OCTET_CYCLES * 3u / 88u + 1u) /* an octet lasts 88 N / 3 cycles */
/* Below this an interrupt an octet would leave gaps: stay until all are sent. */
#ifndef POLLED_BIT_CYCLES
#define POLLED_BIT_CYCLES 80u
#endif
/* our choice: what a UART on the other side bears with its own share, PROFIBUS and Modbus alike. */
#define MAX_ERROR_PERCENT 1u

volatile __bit sending;
volatile __bit burst;
volatile __bit polled;
volatile __bit deaf;
volatile __bit eager;
HOT uint8_t octet;
HOT uint8_t octet_err;
IDATA uint16_t octet_cycles;

static volatile __bit parity; /* the character has a parity bit       */
static volatile __bit odd;    /* it is odd                            */
static volatile __bit seven;  /* seven data bits: the eighth is added */
static const uint8_t XDATA *HOT tx_at;
static HOT uint16_t tx_left;
static IDATA uint16_t bit_cycles; /* a bit lasts bit_cycles + bit_thirds / 3 machine cycles */
static uint8_t bit_thirds;

/* ---- receive ---------------------------------------------------------------------------------------------------------------- */

/* In assembly because SDCC does not know that P follows each change of A. */
void receive_isr(void) __using(2)
{
    __asm
        mov a,_SBUF
        mov _octet,a
        clr _RI
        mov _octet_err,#0
        jnb _parity,00003$
        mov c,_P
        jnb _odd,00001$
        cpl c
    00001$:
        jb _seven,00002$
        jnb _RB8,00002$
        cpl c
    00002$:
        jnc 00003$
        mov _octet_err,#1 ; HAL_ERR_PARITY
    00003$:
    __endasm;
    if (seven)
        octet &= 0x7Fu;
    silence_restart_isr();
}

/* A deaf receiver needs no more than the clock set back: 17 of an octet's 59 cycles, and nothing to save. */
void serial_isr(void) __interrupt(4) __naked
{
    __asm
        jnb _deaf,00001$
        jnb _RI,00001$
        clr _TR0
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        setb _TR0
        clr _RI
        clr _TF0
        clr _endless
        setb _armed
        reti
    00001$:
        ljmp _serial_work_isr
    __endasm;
}

void serial_work_isr(void) __interrupt __using(2)
{
    if (RI) {
        if (eager && !locked && !held_any) {
            burst_isr();
        } else if (sending) {
            RI = 0;
        } else {
            receive_isr();
            if (locked || held_any)
                hold_octet_isr();
            else
                take_isr();
        }
    }
    if (TI) {
        TI = 0;
        if (sending)
            send_next_isr();
        else if (!locked)
            held_serve_isr();
    }
}

/* ---- send ------------------------------------------------------------------------------------------------------------------- */

static HOT uint8_t out;

/* `out` to the line, with its parity or second stop bit. Uses no register but A. */
static void put_isr(void) IN_ISR __naked
{
    __asm
        mov a,_out
        mov c,_P
        jnb _odd,00001$
        cpl c
    00001$:
        jb _parity,00002$
        setb c
    00002$:
        jb _seven,00003$
        mov _TB8,c
        sjmp 00004$
    00003$:
        mov acc.7,c
    00004$:
        mov _SBUF,a
        ret
    __endasm;
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    out = *octets;
    tx_at = octets + 1;
    tx_left = n;
    tx_left--;
    REN = 0;
    TR0 = 0;
    TI = 0;
    deaf = 0;
    eager = 0;
    if (held_any)
        held_drop_isr();
    DRIVER_ON();
    sending = 1;
    put_isr();
}

/* TI comes with the stop bit (in some cores at its end): one bit time more before the driver goes off. */
static void last_stop_bit_isr(void) __using(2)
{
    TL0 = (uint8_t)(0u - bit_cycles);
    TH0 = (uint8_t)((0u - bit_cycles) >> 8);
    TF0 = 0;
    TR0 = 1;
}

void send_next_isr(void) __using(2)
{
    if (polled) {
        TI = 1;
        send_burst_isr();
        return;
    }
    if (tx_left == 0) {
        last_stop_bit_isr();
        return;
    }
    out = *tx_at;
    put_isr();
    tx_at++;
    tx_left--;
}

/* PROFIBUS only: 8E1. The next octet stands ready when TI comes. */
void send_burst_isr(void) __using(2)
{
    while (tx_left) {
        out = *tx_at;
        tx_at++;
        tx_left--;
        __asm
            mov a,_out
        00001$:
            jnb _TI,00001$
            mov c,_P
            mov _TB8,c
            mov _SBUF,a
            clr _TI
        __endasm;
    }
    while (!TI)
        ;
    TI = 0;
    last_stop_bit_isr();
}

void send_end_isr(void) __using(2)
{
    DRIVER_OFF();
    sending = 0;
    RI = 0;
    REN = 1;
    silence_restart_isr();
    if (locked) {
        hold_sent_isr();
        return;
    }
    line_sent_isr();
    look_isr();
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

/* 8 N / 3 machine cycles */
static void set_bit_time(uint16_t n)
{
    bit_cycles = 0;
    bit_thirds = 0;
    for (; n; n--) {
        bit_cycles = (uint16_t)(bit_cycles + 2u);
        bit_thirds = (uint8_t)(bit_thirds + 2u);
        if (bit_thirds >= 3) {
            bit_thirds = (uint8_t)(bit_thirds - 3u);
            bit_cycles++;
        }
    }
}

static void set_format(uint8_t format)
{
    bool nine = format == HAL_8E1 || format == HAL_8O1 || format == HAL_8N2;

    parity = format == HAL_8E1 || format == HAL_8O1 || format == HAL_7E1 || format == HAL_7O1;
    odd = format == HAL_8O1 || format == HAL_7O1;
    seven = format >= HAL_7E1;
    SCON = nine ? SCON_MODE_3 : SCON_MODE_1;
    TB8 = 1;
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    uint16_t n;
    uint8_t irq;

    if (bit_per_s == 0 || format >= HAL_FORMATS)
        return HAL_LINE_NO; /* no loop in this core */
    n = divisor(bit_per_s);
    if (n < MIN_N)
        return HAL_LINE_NO;
    irq = hal_irq_save();
    ES = 0;
    DRIVER_OFF();
    sending = 0;
    deaf = 0;
    eager = 0;
    held_drop_isr();
    set_bit_time(n);
    octet_cycles = hal_tbit(11);
    burst = octet_cycles < BURST_OCTET_CYCLES;
    polled = bit_cycles < POLLED_BIT_CYCLES;
    set_format(format);
    T2CON = 0;
    n = (uint16_t)(0u - n);
    RCAP2L = (uint8_t)n;
    RCAP2H = (uint8_t)(n >> 8);
    TL2 = RCAP2L;
    TH2 = RCAP2H;
    T2CON = T2CON_BAUD;
    silence_open();
    REN = 1;
    ES = 1;
    hal_irq_restore(irq);
    return HAL_LINE_TIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    uint16_t cycles = 0;
    uint8_t thirds = 0;

    for (; n; n--) {
        cycles = (uint16_t)(cycles + bit_cycles);
        thirds = (uint8_t)(thirds + bit_thirds);
        if (thirds >= 3) {
            thirds = (uint8_t)(thirds - 3u);
            cycles++;
        }
        if (cycles < bit_cycles)
            return 0xFFFFu;
    }
    return thirds && cycles != 0xFFFFu ? (hal_dur_t)(cycles + 1u) : cycles;
}
