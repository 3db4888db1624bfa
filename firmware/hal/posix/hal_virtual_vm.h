/* The inside of the port in virtual time, shared by hal_virtual.c (machine, time) and hal_virtual_line.c. */
#ifndef FIELDLING_HAL_VIRTUAL_VM_H
#define FIELDLING_HAL_VIRTUAL_VM_H

#include "hal_virtual.h"

#define HV_FIFO_MAX 64u

/* Hardware (receiver, transmitter, driver) goes on while interrupts are masked; only the upcalls wait.
 * Invariants: fifo[0..pending-1] ended in that order, none later than now; sending implies octets != NULL and
 * sent_n <= n; the driver is on exactly while sending to the line. */
struct hv_vm {
    hv_time now, tick_zero;
    bool on, masked, in_isr, in_loop;
    uint8_t switches;

    hv_time bit; /* 0: line closed */
    uint8_t format, char_bits;
    struct {
        uint8_t octet, err;
        hv_time end;
    } fifo[HV_FIFO_MAX];
    unsigned pending;
    bool overrun;

    hv_time quiet_since, limit;
    bool limit_armed;

    const uint8_t *octets;
    uint16_t n, sent_n;
    hv_time tx_due; /* start of octets[sent_n], or the end of the last one */
    bool sending, sent_pending, driver;
    struct hv_wire wire;
};
extern struct hv_vm hv_vm;

/* Report a service called in the wrong context. */
void hv_main_only(const char *service);
void hv_isr_or_lock(const char *service);

/* When the next upcall is due, were interrupts not masked; make it; may it be made? */
hv_time hv_interrupt_due(void);
void hv_interrupt(void);
bool hv_interruptible(void);

/* The transmitter reaches tx_due. / Driver off, everything in flight forgotten, line closed. */
void hv_transmit(void);
void hv_vm_line_off(void);

#endif
