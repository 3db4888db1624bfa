/* From reset to main(): stack painted for its high-water mark, data, zeros. Hart 0 only; there is no other. */
    .section .start, "ax"
    .globl _start
_start:
    la sp, stack_top
    la t0, stack_bottom
    li t1, 0xA5A5A5A5
1:  sw t1, 0(t0)
    addi t0, t0, 4
    bltu t0, sp, 1b
    la t0, data_load
    la t1, data_start
    la t2, data_end
2:  bgeu t1, t2, 3f
    lw t3, 0(t0)
    sw t3, 0(t1)
    addi t0, t0, 4
    addi t1, t1, 4
    j 2b
3:  la t1, bss_start
    la t2, bss_end
4:  bgeu t1, t2, 5f
    sw zero, 0(t1)
    addi t1, t1, 4
    j 4b
5:  call main
    call core_exit
