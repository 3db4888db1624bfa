# COM86 start-up: reset vector at the top of a 64 kB flash, real mode to flat 32-bit mode, interrupt stubs.
#
# The flash is seen twice: at F0000 (64 kB below 1 MB, where this code is linked to run) and at FFFF0000 (top of 4 GB,
# where the processor starts and where the flash is programmed). RAM is 0..0EFFFF.

        .set    ROM_SEGMENT, 0xF000
        .set    CODE, 0x08              # selectors of the table below
        .set    DATA, 0x10
        .set    VECTOR0, 0x20
        .set    IRQS, 8

        .section .reset, "ax"
        .code16
        ljmp    $ROM_SEGMENT, $start16_offset
        .ascii  "COM86"
        .byte   0

        .section .text.start, "ax"
        .code16
        .globl  start16
start16:
        cli
        cld
        addr32 lgdtl %cs:(gdtr - 0xF0000)
        movl    %cr0, %eax
        orb     $1, %al
        movl    %eax, %cr0
        ljmpl   $CODE, $start32

        .code32
start32:
        movw    $DATA, %ax
        movw    %ax, %ds
        movw    %ax, %es
        movw    %ax, %ss
        movl    $stack_top, %esp

        movl    $data_load, %esi        # initialised data, and the code that must run from RAM
        movl    $data_start, %edi
        movl    $data_size, %ecx
        rep movsb
        movl    $bss_start, %edi        # stack painted for its high-water mark, then zeros
        movl    $bss_size, %ecx
        xorl    %eax, %eax
        rep stosb
        movl    $stack_bottom, %edi
        movl    $stack_size, %ecx
        movb    $0xA5, %al
        rep stosb

        movl    $(idt + VECTOR0 * 8), %edi
        movl    $irq0, %eax
        movl    $IRQS, %ecx
1:      movw    %ax, (%edi)
        movw    $CODE, 2(%edi)
        movw    $0x8E00, 4(%edi)        # present, 32-bit interrupt gate
        movl    %eax, %edx
        shrl    $16, %edx
        movw    %dx, 6(%edi)
        addl    $8, %edi
        addl    $(irq1 - irq0), %eax
        loop    1b
        lidt    idtr
        call    main
        pushl   %eax
        call    pc_exit

        .macro  STUB number
        .align  16
irq\number:
        pushal
        pushl   $\number
        jmp     common
        .endm
        STUB    0
        STUB    1
        STUB    2
        STUB    3
        STUB    4
        STUB    5
        STUB    6
        STUB    7
common:
        cld
        call    pc_irq_isr
        addl    $4, %esp
        popal
        iret

        .section .rodata
        .align  8
gdt:    .quad   0
        .quad   0x00CF9A000000FFFF      # code, 4 GB
        .quad   0x00CF92000000FFFF      # data, 4 GB
gdtr:   .word   . - gdt - 1
        .long   gdt
idtr:   .word   (VECTOR0 + IRQS) * 8 - 1
        .long   idt

        .section .bss
        .align  8
idt:    .skip   (VECTOR0 + IRQS) * 8

        .section .note.GNU-stack, "", @progbits
