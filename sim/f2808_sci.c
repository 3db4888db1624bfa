#include "f2808_sci.h"

#include <string.h>

#define ACCESS_CLOCKS 2u
#define FIFO 16u
#define NEVER UINT64_MAX
#define DRIVER_PIN 0x1000u

enum { SCI = 0x7050, CCR = 0, CTL1, HBAUD, LBAUD, CTL2, RXST, RXEMU, RXBUF, TXBUF = 9, FFTX, FFRX, FFCT };
enum { TIM, TIMH, PRD, PRDH, TCR };
enum { GPAMUX2_HIGH = 0x6F89, GPADIR = 0x6F8A, GPASET = 0x6FC2, GPACLEAR = 0x6FC4, PCLKCR0 = 0x701C, WDKEY = 0x7025 };
enum { LINE_TIMER0, LINE_RX, LINE_TX, LINES };
enum { PIECTRL = 0x0CE0, PIEACK = 0x0CE1, PIEIER1 = 0x0CE2, PIEIER9 = 0x0CF2 };

static struct {
    uint64_t now;
    bool intm, allow, in_isr;
    uint16_t sci[16];
    struct {
        uint8_t octet[FIFO];
        unsigned n;
        uint64_t end; /* of the octet in the shift register; NEVER: empty */
        uint8_t shift;
        bool flag;
    } tx;
    struct {
        uint16_t octet[FIFO];
        unsigned n;
        bool flag, overflow, deaf;
    } rx;
    struct {
        uint32_t period;
        uint64_t zero; /* when it reaches 0; NEVER: stopped */
        uint32_t rest;
        bool ena, flag;
    } timer[2];
    bool ifr[LINES];
    uint16_t pie_on, ier1, ier9, ack;
    uint16_t dir, mux, clocks_on;
    bool driver;
    uint32_t cut;
    void (*vector[LINES])(void);
    struct f2808_wire wire;
} m;

/* ---- interrupts ---------------------------------------------------------------------------------------------------- */

static bool enabled(unsigned line)
{
    static const uint16_t bit[LINES] = {0x40, 0x01, 0x02};
    const uint16_t ier = line == LINE_TIMER0 ? m.ier1 : m.ier9;
    return m.pie_on && (ier & bit[line]) && !(m.ack & (line == LINE_TIMER0 ? 0x001 : 0x100));
}

static void take_interrupts(void)
{
    for (unsigned line = 0; line < LINES; line++) {
        if (m.intm || !m.ifr[line] || !enabled(line) || !m.vector[line])
            continue;
        m.ifr[line] = false;
        m.ack |= line == LINE_TIMER0 ? 0x001 : 0x100;
        m.intm = true;
        m.vector[line]();
        m.intm = false;
        line = (unsigned)-1; /* the first again */
    }
}

static bool requested(void)
{
    for (unsigned line = 0; line < LINES; line++)
        if (m.ifr[line] && enabled(line))
            return true;
    return false;
}

/* ---- transmitter ------------------------------------------------------------------------------------------------------ */

uint64_t f2808_char_clocks(void)
{
    const uint32_t brr = (uint32_t)(m.sci[HBAUD] & 0xFF) << 8 | (m.sci[LBAUD] & 0xFF);
    const uint32_t bit = (brr ? (brr + 1) * 8 : 16) * F2808_LSPCLK_DIVIDER;
    const uint32_t bits = 1u + (m.sci[CCR] & 7u) + 1u + (m.sci[CCR] & 0x20 ? 1u : 0u) + (m.sci[CCR] & 0x80 ? 2u : 1u);
    return (uint64_t)bit * bits;
}

static void request_tx(void)
{
    m.tx.flag = true;
    if (m.sci[FFTX] & 0x20)
        m.ifr[LINE_TX] = true;
}

static void shift_next(void)
{
    if (m.tx.end != NEVER || m.tx.n == 0 || !(m.sci[CTL1] & 0x20) || !(m.sci[CTL1] & 0x02))
        return;
    m.tx.shift = m.tx.octet[0];
    memmove(m.tx.octet, m.tx.octet + 1, --m.tx.n);
    m.tx.end = m.now + f2808_char_clocks();
    if (m.tx.n <= (m.sci[FFTX] & 0x1Fu))
        request_tx();
    if (!(m.sci[CCR] & 0x10) && m.driver && m.wire.octet)
        m.wire.octet(m.tx.shift, m.tx.end);
}

static void shifted(void)
{
    m.tx.end = NEVER;
    if (m.sci[CCR] & 0x10)
        f2808_hear(m.tx.shift, 0);
    shift_next();
}

/* ---- receiver ----------------------------------------------------------------------------------------------------------- */

static void push(uint16_t rxbuf)
{
    if (m.rx.n == FIFO) {
        m.rx.overflow = true;
        return;
    }
    m.rx.octet[m.rx.n++] = rxbuf;
    if (m.rx.n >= (m.sci[FFRX] & 0x1Fu)) {
        m.rx.flag = true;
        if (m.sci[FFRX] & 0x20)
            m.ifr[LINE_RX] = true;
    }
}

void f2808_hear(uint8_t octet, uint8_t errors)
{
    if (m.rx.deaf || (m.sci[CTL1] & 0x21) != 0x21)
        return;
    push((uint16_t)(octet | (errors & 0x10 ? 0x8000 : 0) | (errors & 0x04 ? 0x4000 : 0)));
    if (errors)
        m.sci[RXST] |= (uint16_t)(0x80 | (errors & 0x14));
}

void f2808_hear_break(void)
{
    f2808_hear(0, 0x10);
    m.sci[RXST] |= 0xA0;
    m.rx.deaf = true;
}

static uint16_t read_rxbuf(void)
{
    const uint16_t first = m.rx.octet[0];
    if (m.rx.n)
        memmove(m.rx.octet, m.rx.octet + 1, --m.rx.n * sizeof m.rx.octet[0]);
    return first;
}

/* ---- SCI registers -------------------------------------------------------------------------------------------------------- */

static void sci_reset(void)
{
    m.sci[RXST] = 0;
    m.rx.deaf = false;
    m.tx.end = NEVER;
}

static uint16_t read_sci(unsigned r)
{
    switch (r) {
    case CTL2:
        return (uint16_t)((m.sci[CTL2] & 3u) | (m.tx.n < FIFO ? 0x80u : 0u) | (m.tx.n == 0 && m.tx.end == NEVER ? 0x40u : 0u));
    case RXST:
        return (uint16_t)(m.sci[RXST] | (m.rx.n ? 0x40u : 0u));
    case RXBUF:
        return read_rxbuf();
    case FFTX:
        return (uint16_t)((m.sci[FFTX] & 0xE03F) | m.tx.n << 8 | (m.tx.flag ? 0x80u : 0u));
    case FFRX:
        return (uint16_t)((m.sci[FFRX] & 0x203F) | m.rx.n << 8 | (m.rx.flag ? 0x80u : 0u) | (m.rx.overflow ? 0x8000u : 0u));
    default:
        return m.sci[r];
    }
}

static void write_fftx(uint16_t v)
{
    if (!(v & 0x2000))
        m.tx.n = 0;
    if (v & 0x40)
        m.tx.flag = false;
    m.sci[FFTX] = (uint16_t)(v & 0xE03F);
    if (m.tx.flag && (v & 0x20))
        m.ifr[LINE_TX] = true;
}

static void write_ffrx(uint16_t v)
{
    if (!(v & 0x2000))
        m.rx.n = 0;
    if (v & 0x4000)
        m.rx.overflow = false;
    if (v & 0x40)
        m.rx.flag = false;
    m.sci[FFRX] = (uint16_t)(v & 0x203F);
    if (m.rx.flag && (v & 0x20))
        m.ifr[LINE_RX] = true;
}

static void write_sci(unsigned r, uint16_t v)
{
    switch (r) {
    case CTL1:
        m.sci[CTL1] = v;
        if (!(v & 0x20))
            sci_reset();
        shift_next();
        break;
    case TXBUF:
        if (m.tx.n < FIFO)
            m.tx.octet[m.tx.n++] = (uint8_t)v;
        shift_next();
        break;
    case FFTX:
        write_fftx(v);
        break;
    case FFRX:
        write_ffrx(v);
        break;
    default:
        m.sci[r] = v;
    }
}

/* ---- timers ----------------------------------------------------------------------------------------------------------------- */

static uint32_t timer_value(unsigned t)
{
    return m.timer[t].zero == NEVER ? m.timer[t].rest : (uint32_t)(m.timer[t].zero - m.now);
}

static void write_tcr(unsigned t, uint16_t v)
{
    if (v & 0x8000)
        m.timer[t].flag = false;
    m.timer[t].ena = (v & 0x4000) != 0;
    m.timer[t].rest = v & 0x20 ? m.timer[t].period : timer_value(t);
    m.timer[t].zero = v & 0x10 ? NEVER : m.now + m.timer[t].rest;
}

static void expire(unsigned t)
{
    m.timer[t].flag = true;
    m.timer[t].zero = m.now + m.timer[t].period + 1u;
    if (t == 0 && m.timer[t].ena)
        m.ifr[LINE_TIMER0] = true;
}

static uint16_t read_timer(unsigned t, unsigned r)
{
    const uint32_t v = r == TIM || r == TIMH ? timer_value(t) : m.timer[t].period;
    if (r == TCR)
        return (uint16_t)((m.timer[t].flag ? 0x8000u : 0u) | (m.timer[t].ena ? 0x4000u : 0u) |
                          (m.timer[t].zero == NEVER ? 0x10u : 0u));
    return (uint16_t)(r & 1u ? v >> 16 : v);
}

static void write_timer(unsigned t, unsigned r, uint16_t v)
{
    if (r == PRD)
        m.timer[t].period = (m.timer[t].period & 0xFFFF0000u) | v;
    else if (r == PRDH)
        m.timer[t].period = (m.timer[t].period & 0xFFFFu) | (uint32_t)v << 16;
    else if (r == TCR)
        write_tcr(t, v);
}

/* ---- time -------------------------------------------------------------------------------------------------------------------- */

static uint64_t next_event(void)
{
    uint64_t next = m.tx.end;
    for (unsigned t = 0; t < 2; t++)
        if (m.timer[t].zero < next)
            next = m.timer[t].zero;
    return next;
}

static void happen(void)
{
    if (m.tx.end <= m.now)
        shifted();
    for (unsigned t = 0; t < 2; t++)
        if (m.timer[t].zero <= m.now)
            expire(t);
    if (m.wire.tick)
        m.wire.tick();
}

#define TICK_CLOCKS 20000u

void f2808_run(uint64_t clocks)
{
    const uint64_t end = m.now + clocks;
    while (m.now < end) {
        uint64_t next = next_event();
        if (next > m.now + TICK_CLOCKS)
            next = m.now + TICK_CLOCKS;
        m.now = next < end ? next : end;
        happen();
        take_interrupts();
    }
}

uint64_t f2808_now(void)
{
    return m.now;
}

void f2808_idle(void)
{
    const bool masked = m.intm;
    while (!requested())
        f2808_run(1000);
    m.intm = false;
    take_interrupts();
    m.intm = masked;
}

bool f2808_mask(void)
{
    const bool were_on = !m.intm;
    m.intm = true;
    return were_on;
}

void f2808_unmask(void)
{
    m.intm = false;
    take_interrupts();
}

/* ---- the bus of the CPU -------------------------------------------------------------------------------------------------- */

void f2808_power_on(void)
{
    memset(&m, 0, sizeof m);
    m.intm = true;
    m.tx.end = NEVER;
    m.timer[0].zero = m.timer[1].zero = NEVER;
    m.timer[0].period = m.timer[1].period = 0xFFFFFFFFu;
    m.sci[FFTX] = 0xA000;
    m.sci[FFRX] = 0x201F;
}

void f2808_set_wire(const struct f2808_wire *wire)
{
    m.wire = *wire;
}

void f2808_vectors(void (*timer0)(void), void (*rx)(void), void (*tx)(void))
{
    m.vector[LINE_TIMER0] = timer0;
    m.vector[LINE_RX] = rx;
    m.vector[LINE_TX] = tx;
}

void f2808_allow(bool on)
{
    m.allow = on;
}

bool f2808_driver(void)
{
    return m.driver;
}

uint32_t f2808_cut(void)
{
    return m.cut;
}

static void set_driver(bool on)
{
    if (!(m.dir & DRIVER_PIN))
        return;
    if (m.driver && !on && (m.tx.end != NEVER || m.tx.n))
        m.cut++;
    m.driver = on;
}

/* The SCI is dead without its clock, and unheard without its pins. */
static bool sci_there(void)
{
    return (m.clocks_on & 0x0400) && (m.mux & 0x0F00) == 0x0500;
}

uint16_t f2808_read(uint16_t address)
{
    f2808_run(ACCESS_CLOCKS);
    if (address >= SCI && address <= SCI + 0xF)
        return sci_there() ? read_sci(address - SCI) : 0;
    if (address >= 0x0C00 && address <= 0x0C0F)
        return read_timer(address >> 3 & 1u, address & 7u);
    switch (address) {
    case GPADIR:
        return m.dir;
    case PCLKCR0:
        return m.clocks_on;
    default:
        return 0;
    }
}

static void write_protected(uint16_t address, uint16_t value)
{
    if (!m.allow)
        return;
    if (address == GPADIR)
        m.dir = value;
    else if (address == GPAMUX2_HIGH)
        m.mux = value;
    else if (address == PCLKCR0)
        m.clocks_on = value;
}

void f2808_write(uint16_t address, uint16_t value)
{
    f2808_run(ACCESS_CLOCKS);
    if (address >= SCI && address <= SCI + 0xF && sci_there())
        write_sci(address - SCI, value);
    else if (address >= 0x0C00 && address <= 0x0C0F)
        write_timer(address >> 3 & 1u, address & 7u, value);
    else if (address == PIECTRL)
        m.pie_on = value & 1u;
    else if (address == PIEACK)
        m.ack &= (uint16_t)~value;
    else if (address == PIEIER1)
        m.ier1 = value;
    else if (address == PIEIER9)
        m.ier9 = value;
    else if (address == GPASET && (value & DRIVER_PIN))
        set_driver(true);
    else if (address == GPACLEAR && (value & DRIVER_PIN))
        set_driver(false);
    else
        write_protected(address, value);
    take_interrupts();
}
