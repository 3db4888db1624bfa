/* From reset to main(): vectors, data, stack. Source: ARMv7-M Architecture Reference Manual, B1.5. */
#include "hal/cortexm/core.h"

#define FAULT_STATUS 255 /* a fault is our bug, like a failed ASSERT */

extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_bottom[], stack_top[];
int main(void);

void core_start(void);

/* Data, zeros, and the stack painted for its high-water mark. */
void core_start(void)
{
    const uint32_t *from = data_load;
    uint32_t *to;
    uint32_t *sp;

    __asm__ volatile("mov %0, sp" : "=r"(sp));
    for (to = data_start; to < data_end; to++)
        *to = *from++;
    for (to = bss_start; to < bss_end; to++)
        *to = 0;
    for (to = stack_bottom; to < sp - 16; to++)
        *to = 0xA5A5A5A5u;
    core_exit(main());
}

static void fault(void)
{
    core_exit(FAULT_STATUS);
}

typedef void (*vector)(void);
extern const vector part_vectors[]; /* of the part, behind the sixteen of the core */

__attribute__((section(".vectors"), used)) static const vector core_vectors[16] = {
    (vector)(uintptr_t)stack_top, core_start, fault, fault, fault, fault, fault,
};
