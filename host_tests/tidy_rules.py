#!/usr/bin/env python3
"""firmware/hal/mcs51/tidy does what its rules say, and nothing else: assembly in, assembly out, worked out by hand.

Instructions stand between slashes. `f` is the function looked at; behind `|` stand others, each a name, a colon and its code,
behind `||` those of another file.
"""
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "firmware" / "hal" / "mcs51" / "tidy"))
from whole import tidy  # noqa: E402
from asm import Program  # noqa: E402

S = "mov dptr,#_f_x_65536_1"
KEEP = "_keep:ret"  # changes nothing; of _elsewhere nothing is known
SAME = None  # nothing may change
CASES = {
    # ---- own memory ----
    "an argument that is stored and loaded at once stays in A": (
        f"mov a,dpl / {S} / movx @dptr,a / movx a,@dptr / mov r7,a / mov _g,r7 / mov _h,r7 / ret",
        "mov a,dpl / mov _g,a / mov _h,a / ret"),
    "an argument needed behind a call moves into a register that the call leaves alone": (
        f"mov a,dpl / {S} / movx @dptr,a / lcall _g7 / {S} / movx a,@dptr / mov _g,a / ret | _g7:mov r2,_h / mov a,r2 / add a,r2 / mov _g,a / ret",
        "mov r3,dpl / lcall _g7 / mov _g,r3 / ret"),
    "behind a call of the library it stays in memory": (
        f"mov a,dpl / {S} / movx @dptr,a / lcall _elsewhere / {S} / movx a,@dptr / mov _g,a / ret", SAME),
    "a static variable, wanted when the function begins, is stored": (
        f"{S} / movx a,@dptr / mov _g,a / inc a / movx @dptr,a / ret", SAME),
    "a variable whose address is given away is stored": (
        f"mov a,dpl / {S} / movx @dptr,a / mov _g,#_f_x_65536_1 / ret", SAME),
    "a variable whose address a call gets is stored": (
        f"mov a,dpl / {S} / movx @dptr,a / lcall _elsewhere / mov _g,#1 / ret", SAME),
    "a variable that DPTR goes on from to an unknown place is stored": (
        f"{S} / mov a,#1 / movx @dptr,a / mov a,_g / movc a,@a+dptr / mov _g,a / ret", SAME),
    "a variable that start-up names is stored": (
        "mov dptr,#_f_y_65536_2 / mov a,#1 / movx @dptr,a / ret", SAME),
    "a static of the file is no local": ("mov dptr,#_x / mov a,#1 / movx @dptr,a / ret", SAME),
    "in an interrupt function nothing moves into a register": (
        f"push acc / push dpl / push dph / {S} / mov a,#1 / movx @dptr,a / lcall _a / {S} / movx a,@dptr / mov _g,a / "
        "pop dph / pop dpl / pop acc / reti | _a:mov a,_g / mov dptr,#_x / movx @dptr,a / ret", SAME),
    # ---- DPTR ----
    "the next octet of a place is one step away": (
        "mov dptr,#_x / mov a,_g / movx @dptr,a / mov dptr,#(_x + 0x0001) / mov a,_h / movx @dptr,a / ret",
        "mov dptr,#_x / mov a,_g / movx @dptr,a / inc dptr / mov a,_h / movx @dptr,a / ret"),
    "two octets on it is set anew": (
        "mov dptr,#_x / mov a,_g / movx @dptr,a / mov dptr,#(_x + 0x0002) / mov a,_h / movx @dptr,a / ret", SAME),
    "it is set already": (
        "mov dptr,#_x / movx a,@dptr / add a,_g / mov dptr,#_x / movx @dptr,a / ret",
        "mov dptr,#_x / movx a,@dptr / add a,_g / movx @dptr,a / ret"),
    "a call that sets it": (
        "mov dptr,#_x / movx a,@dptr / lcall _d / mov dptr,#_x / movx @dptr,a / ret | _d:mov dptr,#_y / movx @dptr,a / ret",
        SAME),
    "a call that leaves it": (
        "mov dptr,#_x / mov a,#3 / movx @dptr,a / lcall _c / mov dptr,#_x / movx @dptr,a / ret | _c:mov _g,#0 / ret",
        "mov dptr,#_x / mov a,#3 / movx @dptr,a / lcall _c / movx @dptr,a / ret"),
    "the same pointer, some octets on": (
        "mov dpl,_p / mov dph,(_p + 1) / inc dptr / movx a,@dptr / mov _g,a / "
        "mov dpl,_p / mov dph,(_p + 1) / inc dptr / inc dptr / movx a,@dptr / mov _h,a / ret",
        "mov dpl,_p / mov dph,(_p + 1) / inc dptr / movx a,@dptr / mov _g,a / inc dptr / movx a,@dptr / mov _h,a / ret"),
    "the pointer has changed meanwhile": (
        "mov dpl,_p / mov dph,(_p + 1) / movx a,@dptr / mov _p,a / mov dpl,_p / mov dph,(_p + 1) / movx a,@dptr / mov _h,a / ret",
        "mov dpl,_p / mov dph,(_p + 1) / movx a,@dptr / mov _p,a / mov dpl,a / movx a,@dptr / mov _h,a / ret"),
    # ---- what is known ----
    "a volatile variable is read each time": ("mov a,_v / mov _g,a / mov a,_v / mov _h,a / ret",
                                              "mov _g,_v / mov _h,_v / ret"),
    "a volatile one in external RAM, too": (
        "mov dptr,#_w / movx a,@dptr / mov _g,a / movx a,@dptr / mov _h,a / ret", SAME),
    "a volatile one is written each time": ("mov _v,#1 / mov _v,#1 / ret", SAME),
    "a port is read each time": ("mov a,_SBUF / mov a,_SBUF / mov _g,a / ret", "mov a,_SBUF / mov _g,_SBUF / ret"),
    "what stands behind a pointer is read each time": (
        "movx a,@r0 / mov _g,a / movx a,@r0 / mov _h,a / ret", SAME),
    "a store through a pointer may change a variable": (
        "mov dptr,#_x / movx a,@dptr / mov _g,a / movx @r0,a / movx a,@dptr / mov _h,a / ret", SAME),
    "a call may change a variable": (
        f"mov dptr,#_x / movx a,@dptr / mov _g,a / lcall _keep / movx a,@dptr / mov _h,a / ret | {KEEP}", SAME),
    "a call may change registers": (
        "mov r7,_g / lcall _elsewhere / mov r7,_g / mov _h,r7 / mov _p,r7 / ret",
        "lcall _elsewhere / mov r7,_g / mov _h,r7 / mov _p,r7 / ret"),
    "another bank's registers are others": (
        f"mov r7,#1 / mov psw,#0x08 / lcall _keep / mov psw,#0x00 / mov a,_h / add a,r7 / mov _g,a / ret | {KEEP}", SAME),
    "both ways to a label agree": (
        "mov a,_g / jb _bit,00101$ / mov _h,#1 / 00101$: / mov a,_g / mov _p,a / ret",
        "mov a,_g / jb _bit,00101$ / mov _h,#1 / 00101$: / mov _p,a / ret"),
    "one way to the label knows something else": (
        "mov a,_g / jz 00101$ / inc a / 00101$: / mov a,_g / mov _p,a / ret",
        "mov a,_g / jz 00101$ / 00101$: / mov _p,_g / ret"),
    "a loop's head knows nothing": (
        "mov a,_g / 00101$: / add a,_h / mov _p,a / mov a,_g / djnz r7,00101$ / ret", SAME),
    "behind jz A is zero": ("mov a,_g / jz 00101$ / ret / 00101$: / clr a / mov _p,a / ret",
                            "mov a,_g / jz 00101$ / ret / 00101$: / mov _p,a / ret"),
    "the next octet of a structure": (
        "mov a,#0x0d / add a,r6 / mov r1,a / movx a,@r1 / mov _g,a / mov a,#0x0e / add a,r6 / mov r1,a / movx a,@r1 / mov _h,a / ret",
        "mov a,#0x0d / add a,r6 / mov r1,a / movx a,@r1 / mov _g,a / inc r1 / movx a,@r1 / mov _h,a / ret"),
    "its carry is wanted": (
        "mov a,#0x0d / add a,r6 / mov r1,a / movx a,@r1 / mov _g,a / mov a,#0x0e / add a,r6 / mov r1,a / clr a / addc a,r7 / "
        "movx @r1,a / ret",
        "mov a,#0x0d / add a,r6 / mov r1,a / movx a,@r1 / mov _g,a / mov a,#0x0e / add a,r6 / inc r1 / clr a / addc a,r7 / "
        "movx @r1,a / ret"),
    "a copy in another register": (
        "mov r3,_g / mov a,r3 / mov r6,a / lcall _c / mov a,_h / add a,r6 / mov _h,a / mov a,_p / add a,r6 / mov _p,a / ret | "
        "_c:mov a,_x / mov _h,a / mov _p,a / ret",
        "mov r3,_g / lcall _c / mov a,_h / add a,r3 / mov _h,a / mov a,_p / add a,r3 / mov _p,a / ret"),
    "a copy that outlives its original": (
        "mov r3,_g / mov a,r3 / mov r6,a / inc r3 / mov a,r3 / add a,r3 / mov _h,a / mov _p,r6 / mov _v,r6 / ret",
        SAME),
    # ---- what nobody reads ----
    "a value that passes through a register": ("mov r7,_g / mov a,r7 / add a,_h / mov _p,a / ret",
                                               "mov a,_g / add a,_h / mov _p,a / ret"),
    "a register that a branch still wants": (
        "mov r7,_g / mov a,r7 / jz 00101$ / ret / 00101$: / mov _h,r7 / mov _p,r7 / ret",
        "mov a,_g / jz 00101$ / ret / 00101$: / mov _h,a / mov _p,a / ret"),
    "the flags of what is not read may be wanted": ("mov a,_g / add a,#0xff / jc 00101$ / ret / 00101$: / mov _h,#1 / ret", SAME),
    "a result that a caller wants": (
        "lcall _r / mov _g,dpl / mov _h,dph / ret | _r:mov dpl,_p / mov dph,(_p + 1) / ret", SAME),
    "push and pop around a call that leaves the register": (
        "mov r7,dpl / push ar7 / lcall _c / pop ar7 / mov _g,r7 / mov _h,r7 / ret | _c:mov _g,#0 / ret",
        "mov r7,dpl / lcall _c / mov _g,r7 / mov _h,r7 / ret"),
    "push and pop around one that does not": (
        "mov r7,dpl / push ar7 / lcall _c / pop ar7 / mov _g,r7 / mov _h,r7 / ret | _c:mov r7,#1 / mov _g,r7 / mov _h,r7 / ret",
        "mov r2,dpl / lcall _c / mov _g,r2 / mov _h,r2 / ret"),
    "push and pop around one that may change any register": (
        "mov r7,dpl / push ar7 / lcall _elsewhere / pop ar7 / mov _g,r7 / mov _h,r7 / ret", SAME),
    "in an interrupt function no other register is used": (
        "push acc / push ar7 / lcall _c / pop ar7 / pop acc / reti | _c:mov a,_h / mov r7,a / add a,r7 / mov _g,a / mov _h,r7 / ret",
        SAME),
    "a bit of the function's own": ("mov _f_sloc0_1_0,c / clr a / rlc a / mov _g,a / ret", "clr a / rlc a / mov _g,a / ret"),
    "a bit of the file": ("mov _bit,c / clr a / rlc a / mov _g,a / ret", SAME),
    "and, or in a register": ("mov r6,_g / anl ar6,#0x0f / mov a,r6 / movx @r0,a / ret",
                              "mov a,_g / anl a,#0x0f / movx @r0,a / ret"),
    "a member of what a pointer that is a variable's points to": (
        "mov ((_g + 0x0001) + 1),a / mov a,(_g + 0x0002) / mov _h,a / mov _p,a / ret",
        "mov ((_g + 0x0001) + 1),a / mov _h,a / mov _p,a / ret"),
    "a pointer in memory counts in DPTR": (
        "mov dpl,_p / mov dph,(_p + 1) / mov a,_g / movx @dptr,a / inc _p / clr a / cjne a,_p,00101$ / inc (_p + 1) / 00101$: / "
        "mov dpl,_p / mov dph,(_p + 1) / mov a,_h / movx @dptr,a / inc _p / clr a / cjne a,_p,00102$ / inc (_p + 1) / 00102$: / "
        "mov dpl,_p / mov dph,(_p + 1) / mov a,r7 / movx @dptr,a / ret",
        "mov dpl,_p / mov dph,(_p + 1) / mov a,_g / movx @dptr,a / inc dptr / mov a,_h / movx @dptr,a / "
        "inc dptr / mov _p,dpl / mov (_p + 0x0001),dph / mov a,r7 / movx @dptr,a / ret"),
    "one that is not used again": (
        "mov dpl,_p / mov dph,(_p + 1) / mov a,_g / movx @dptr,a / inc _p / clr a / cjne a,_p,00101$ / inc (_p + 1) / 00101$: / ret",
        SAME),
    "DPTR as it was is wanted": (
        "mov dpl,_p / mov dph,(_p + 1) / mov a,_g / movx @dptr,a / inc _p / clr a / cjne a,_p,00101$ / inc (_p + 1) / 00101$: / "
        "mov r7,dpl / mov dpl,_p / mov dph,(_p + 1) / mov a,r7 / movx @dptr,a / mov _h,a / ret", SAME),
    "DPTR is another one": (
        "mov dpl,_g / mov dph,(_p + 1) / mov a,_g / movx @dptr,a / inc _p / clr a / cjne a,_p,00101$ / inc (_p + 1) / 00101$: / "
        "mov dpl,_p / mov dph,(_p + 1) / movx @dptr,a / ret", SAME),
    "a variable set twice": ("mov _g,_h / mov _g,r7 / ret", "mov _g,r7 / ret"),
    "a variable set twice, and read between": ("mov _g,_h / mov a,r6 / add a,_g / mov _p,a / mov _g,r7 / ret", SAME),
    "a variable set twice, and perhaps read by a pointer": ("mov _g,_h / mov a,@r0 / mov _p,a / mov _g,r7 / ret",
                                                            "mov _g,_h / mov _p,@r0 / mov _g,r7 / ret"),
    "a variable set twice, a call between": (f"mov _g,_h / lcall _keep / mov _g,r7 / ret | {KEEP}", SAME),
    "a variable set twice, a branch between": ("mov _g,_h / jc 00101$ / mov _g,r7 / 00101$: / ret", SAME),
    # ---- strides ----
    "five octets on": (
        "mov dpl,_p / mov dph,(_p + 1) / inc dptr / inc dptr / inc dptr / inc dptr / inc dptr / movx a,@dptr / mov _g,a / ret",
        "mov a,_p / add a,#0x05 / mov dpl,a / clr a / addc a,(_p + 1) / mov dph,a / movx a,@dptr / mov _g,a / ret"),
    "five octets on, with what is to be stored in A": (
        "mov a,_g / mov dpl,_p / mov dph,(_p + 1) / inc dptr / inc dptr / inc dptr / inc dptr / inc dptr / movx @dptr,a / ret",
        SAME),
    "five octets on, with a carry in hand": (
        "add a,_h / mov dpl,_p / mov dph,(_p + 1) / inc dptr / inc dptr / inc dptr / inc dptr / inc dptr / movx a,@dptr / "
        "addc a,#0x00 / mov _g,a / ret", SAME),
    # ---- sums of 16 bits ----
    "the sum is one more than DPTR": (
        "mov dpl,r6 / mov dph,r7 / inc dptr / movx a,@dptr / mov _g,a / "
        "mov a,#0x02 / add a,r6 / mov dpl,a / clr a / addc a,r7 / mov dph,a / movx a,@dptr / mov _h,a / ret",
        "mov dpl,r6 / mov dph,r7 / inc dptr / movx a,@dptr / mov _g,a / inc dptr / movx a,@dptr / mov _h,a / ret"),
    "it is what DPTR is": (
        "mov dpl,r6 / mov dph,r7 / inc dptr / movx a,@dptr / mov _g,a / "
        "mov a,#0x01 / add a,r6 / mov dpl,a / clr a / addc a,r7 / mov dph,a / movx a,@dptr / mov _h,a / ret",
        "mov dpl,r6 / mov dph,r7 / inc dptr / movx a,@dptr / mov _g,a / movx a,@dptr / mov _h,a / ret"),
    "two octets more": (
        "mov dpl,r6 / mov dph,r7 / inc dptr / movx a,@dptr / mov _g,a / "
        "mov a,#0x03 / add a,r6 / mov dpl,a / clr a / addc a,r7 / mov dph,a / movx a,@dptr / mov _h,a / ret", SAME),
    "with another carry": (
        "mov dpl,r6 / mov dph,r7 / inc dptr / movx a,@dptr / mov _g,a / "
        "mov a,#0x02 / add a,r6 / mov dpl,a / clr a / setb c / addc a,r7 / mov dph,a / movx a,@dptr / mov _h,a / ret", SAME),
    "whose high half is wanted": (
        "mov dpl,r6 / mov dph,r7 / movx a,@dptr / mov _g,a / "
        "mov a,#0x01 / add a,r6 / mov dpl,a / clr a / addc a,r7 / mov dph,a / mov _h,a / movx a,@dptr / mov _p,a / ret", SAME),
    "one octet behind a sum that is kept": (
        "mov a,#0xfe / add a,_p / mov r6,a / mov a,(_p + 1) / addc a,#0xff / mov r7,a / mov dpl,r6 / mov dph,a / "
        "movx a,@dptr / mov _g,a / mov dpl,_p / mov dph,(_p + 1) / movx a,@dptr / mov _h,a / "
        "mov a,#0xff / add a,_p / mov dpl,a / mov a,(_p + 1) / addc a,#0xff / mov dph,a / movx a,@dptr / mov _p,a / "
        "mov dpl,r6 / mov dph,r7 / inc dptr / inc dptr / movx a,@dptr / mov (_p + 1),a / ret",
        "mov a,#0xfe / add a,_p / mov r6,a / mov a,(_p + 1) / addc a,#0xff / mov dpl,r6 / mov dph,a / "
        "movx a,@dptr / mov _g,a / mov dpl,_p / mov dph,(_p + 1) / movx a,@dptr / mov _h,a / "
        "mov a,#0xff / add a,_p / mov dpl,a / mov a,(_p + 1) / addc a,#0xff / mov dph,a / movx a,@dptr / mov _p,a / "
        "inc dptr / movx a,@dptr / mov (_p + 1),a / ret"),
    "one more of a pointer in registers": (
        "mov dpl,r6 / mov dph,r7 / movx a,@dptr / mov _g,a / inc r6 / mov dpl,r6 / mov dph,r7 / movx a,@dptr / mov _h,a / ret",
        "mov dpl,r6 / mov dph,r7 / movx a,@dptr / mov _g,a / inc r6 / mov dpl,r6 / movx a,@dptr / mov _h,a / ret"),
    "a variable counted in A": ("mov a,_g / dec a / mov _g,a / ret", "dec _g / ret"),
    "a variable counted in A, where it is wanted": (
        "mov a,_g / inc a / mov _g,a / add a,_h / mov _h,a / ret", "inc _g / mov a,_g / add a,_h / mov _h,a / ret"),
    "a volatile variable counted in A": ("mov a,_v / inc a / mov _v,a / ret", SAME),
    # ---- values carried to a label ----
    "a result that is stored behind a label": (
        "mov a,_h / jz 00101$ / mov dpl,#1 / sjmp 00102$ / 00101$: / mov dpl,r6 / 00102$: / mov _g,dpl / inc _p / ret",
        "mov a,_h / jz 00101$ / mov _g,#1 / sjmp 00102$ / 00101$: / mov _g,r6 / 00102$: / inc _p / ret"),
    "one that is wanted behind it": (
        "mov a,_h / jz 00101$ / mov dpl,#1 / sjmp 00102$ / 00101$: / mov dpl,r6 / 00102$: / mov _g,dpl / lcall _elsewhere / inc _p / ret",
        SAME),
    "one that a branch leads to": (
        "mov dpl,r5 / mov a,_h / jz 00102$ / mov dpl,r6 / 00102$: / mov _g,dpl / inc _p / ret", SAME),
    "one that one way does not set last": (
        "mov a,_h / jz 00101$ / mov dpl,#1 / sjmp 00102$ / 00101$: / mov dpl,r6 / inc _p / 00102$: / mov _g,dpl / inc _p / ret", SAME),
    "one for a port": (
        "mov a,_h / jz 00101$ / mov dpl,#1 / sjmp 00102$ / 00101$: / mov dpl,r6 / 00102$: / mov _SBUF,dpl / inc _p / ret", SAME),
    "from register to register there is no way": (
        "mov a,_h / jz 00101$ / mov dpl,#1 / sjmp 00102$ / 00101$: / mov dpl,r6 / 00102$: / mov r3,dpl / mov a,r3 / add a,r3 / mov _g,a / ret", SAME),
    # ---- tests whose outcome is known ----
    "a result that is looked at again": (
        "mov a,_g / jz 00101$ / mov dpl,#1 / sjmp 00102$ / 00101$: / mov dpl,#0 / 00102$: / mov a,dpl / jz 00103$ / mov _h,#1 / "
        "ret / 00103$: / mov _p,#1 / ret",
        "mov a,_g / jz 00103$ / mov _h,#1 / ret / 00103$: / mov _p,#1 / ret"),
    "a result in a bit": (
        "mov a,_g / jz 00101$ / setb _f_sloc0_1_0 / sjmp 00102$ / 00101$: / clr _f_sloc0_1_0 / 00102$: / mov c,_f_sloc0_1_0 / "
        "clr a / rlc a / mov dpl,a / mov a,dpl / jz 00103$ / mov _h,#1 / ret / 00103$: / mov _p,#1 / ret",
        "mov a,_g / jz 00103$ / mov _h,#1 / ret / 00103$: / mov _p,#1 / ret"),
    "a result in a bit that others see": (
        "mov a,_g / jz 00101$ / setb _bit / sjmp 00102$ / 00101$: / clr _bit / 00102$: / mov c,_bit / "
        "clr a / rlc a / jz 00103$ / mov _h,#1 / ret / 00103$: / mov _p,#1 / ret", SAME),
    "a comparison says which is less, too": (
        "mov a,_g / jz 00101$ / mov r7,#1 / sjmp 00102$ / 00101$: / mov r7,_h / 00102$: / cjne r7,#0x02,00103$ / 00103$: / "
        "clr a / rlc a / mov _p,a / ret",
        "mov a,_g / jz 00101$ / setb c / sjmp 00103$ / 00101$: / mov r7,_h / cjne r7,#0x02,00103$ / 00103$: / clr a / rlc a / mov _p,a / ret"),
    "a number that is another one": (
        "mov r7,#0x00 / mov a,_g / cjne r7,#0x00,00101$ / mov _h,a / ret / 00101$: / mov _p,a / ret", "mov _h,_g / ret"),
    "a bit of a number": ("mov a,#0x04 / mov _g,a / jnb acc.2,00101$ / mov _h,#1 / 00101$: / ret", "mov _g,#0x04 / mov _h,#1 / ret"),
    # ---- ways ----
    "a block behind a jump that leads there": (
        "mov a,_g / jz 00101$ / mov _h,a / sjmp 00103$ / 00101$: / mov _h,#2 / ret / 00103$: / mov _p,a / ret",
        "mov a,_g / jz 00101$ / mov _h,a / mov _p,a / ret / 00101$: / mov _h,#2 / ret"),
    "a block that another one runs on into": (
        "mov a,_g / jz 00101$ / mov _h,a / sjmp 00103$ / 00101$: / mov _h,#2 / 00103$: / mov _p,a / ret", SAME),
    "a block that would be too far from a branch": (
        "mov a,_g / jz 00101$ / mov _h,a / " + "inc _p / " * 30 + "sjmp 00103$ / 00101$: / mov _h,#2 / jb _bit,00103$ / ret / 00103$: / " +
        "inc _p / " * 40 + "mov _p,a / ret",
        "mov a,_g / jz 00101$ / mov _h,a / " + "inc _p / " * 30 + "sjmp 00103$ / 00101$: / mov _h,#2 / jb _bit,00103$ / ret / 00103$: / " +
        "inc _p / " * 40 + "mov _p,a / ret"),
    "a call before the end is a jump": ("lcall _elsewhere / ret", "ljmp _elsewhere"),
    "in an interrupt function it is a call": ("push acc / mov a,_g / mov _h,a / lcall _elsewhere / pop acc / reti", SAME),
    "a jump to the end is the end": (
        "jnb _bit,00101$ / mov _g,#1 / sjmp 00102$ / 00101$: / mov _g,#2 / 00102$: / ret",
        "jnb _bit,00101$ / mov _g,#1 / ret / 00101$: / mov _g,#2 / ret"),
    "a jump to a jump": (
        "00100$: / jnb _bit,00101$ / sjmp 00100$ / 00101$: / sjmp 00100$", "00100$: / jnb _bit,00100$ / sjmp 00100$"),
    "a branch around a jump": ("jz 00101$ / sjmp 00102$ / 00101$: / mov _g,#1 / 00102$: / mov _h,#1 / ret",
                               "jnz 00102$ / mov _g,#1 / 00102$: / mov _h,#1 / ret"),
    "a branch that takes the bit along is not turned round": (
        "jbc _bit,00101$ / sjmp 00102$ / 00101$: / mov _g,#1 / 00102$: / mov _h,#1 / ret", SAME),
    # ---- branches ----
    "a branch that has become too long": (
        "mov a,_g / jz 00101$ / " + "inc _p / " * 70 + "00101$: / ret",
        "mov a,_g / jnz 00102$ / ljmp 00101$ / 00102$: / " + "inc _p / " * 70 + "00101$: / ret"),
    "one that has no opposite": (
        "mov a,_g / cjne a,#0x01,00101$ / " + "inc _p / " * 70 + "00101$: / mov _h,#1 / ret",
        "mov a,_g / cjne a,#0x01,00103$ / sjmp 00102$ / 00103$: / ljmp 00101$ / 00102$: / " + "inc _p / " * 70 + "00101$: / mov _h,#1 / ret"),
    "one with a place for a jump nearby": (
        "mov a,_g / cjne a,_h,00101$ / jnz 00102$ / ret / 00102$: / " + "inc _p / " * 70 + "00101$: / mov _h,#1 / ret",
        "mov a,_g / cjne a,_h,00104$ / jnz 00102$ / ret / 00104$: / ljmp 00101$ / 00102$: / " + "inc _p / " * 70 + "00101$: / mov _h,#1 / ret"),
    "what no way leads to": ("ljmp _elsewhere / mov _g,#1 / 00101$: / mov _h,#1 / ret", "ljmp _elsewhere"),
    # ---- left alone ----
    "written by hand": (";naked function: no prologue. / mov a,_g / mov a,_g / mov r7,a / ret", SAME),
    "some of it written by hand": ("mov a,_g / mov a,_g / mov r7,a / ; x.c:3: __endasm; / ret", SAME),
    "an address of a label": ("mov a,_g / mov a,_g / mov dptr,#00101$ / push dpl / push dph / ret / 00101$: / ret", SAME),
    "a table of jumps": ("mov a,_g / mov a,_g / mov dptr,#00101$ / jmp @a+dptr / 00101$: / ret", SAME),
    "a frame on the stack": ("push _bp / mov _bp,sp / mov a,_g / mov a,_g / mov r7,a / pop _bp / ret", SAME),
}
HEAD = """
\t.globl _f
\t.globl _x
\t.globl _g
\t.globl _h
\t.globl _p
_SBUF\t=\t0x0099
\t.area DSEG    (DATA)
_g:
_h:
_v:
_p:
\t.area BSEG    (BIT)
_bit:
_f_sloc0_1_0:
\t.area XSEG    (XDATA)
_x:
_y:
_w:
_f_x_65536_1:
_f_y_65536_2:
\t.area GSINIT  (CODE)
\tmov\tdptr,#_f_y_65536_2
\t.area CSEG    (CODE)
_f:
\tar0 = 0x00
"""
CALLED_ONCE = {
    "a function called once": (
        "mov a,_g / lcall _c / mov _h,a / ret | _c:add a,_p / jz 00101$ / inc a / ret / 00101$: / cpl a / ret",
        "mov a,_g / ; _c / add a,_p / jz 00101$ / inc a / sjmp 00103$ / 00101$: / cpl a / 00103$: / mov _h,a / ret"),
    "one that goes on into another": (
        "lcall _c / mov _h,a / ret | _c:mov a,_g / jz 00101$ / ljmp _elsewhere / 00101$: / ret",
        "; _c / mov a,_g / jz 00103$ / lcall _elsewhere / 00103$: / mov _h,a / ret"),
    "one that several jumps lead to": (
        "mov a,_g / jz 00101$ / ljmp _c / 00101$: / mov _h,a / ljmp _c | _c:inc _p / ret",
        "mov a,_g / jnz 00102$ / mov _h,a / 00102$: / ; _c / inc _p / ret"),
    "one too long for the branch around it stands apart": (
        "mov a,_g / jz 00101$ / lcall _c / 00101$: / mov _h,a / ret | _c:" + "inc _p / " * 70 + "ret",
        "mov a,_g / jz 00101$ / ljmp 00102$ / 00101$: / mov _h,a / ret / 00102$: / ; _c / " + "inc _p / " * 70 + "ljmp 00101$"),
    "one that stands apart and goes on where a way around its end does": (
        "mov a,_g / jz 00101$ / jc 00103$ / ljmp _c / 00103$: / 00101$: / mov _h,a / ret | _c:" + "inc _p / " * 70 + "ret",
        "mov a,_g / jz 00101$ / ljmp 00104$ / 00101$: / mov _h,a / ret / 00104$: / jc 00103$ / ljmp 00105$ / 00103$: / ljmp 00101$ / "
        "00105$: / ; _c / " + "inc _p / " * 70 + "ret"),
    "one called twice": ("lcall _c / lcall _c / mov _h,a / ret | _c:inc _p / inc _g / ret", SAME),
    "one called and jumped to": ("lcall _c / mov _h,a / ljmp _c | _c:inc _p / inc _g / ret", SAME),
    "what is known at the call is known in it": (
        "mov a,_g / mov r7,a / lcall _c / mov a,r7 / add a,_g / mov _h,a / ret | _c:mov a,_g / mov _p,a / ret",
        "mov a,_g / ; _c / mov _p,a / add a,_g / mov _h,a / ret"),
    "one whose address is taken": ("lcall _c / mov _h,a / ret | _c:inc _p / ret | _other:mov dptr,#_c / ret", SAME),
    "one written by hand": ("lcall _c / mov _h,a / ret | _c:;naked function: no prologue. / inc _p / ret", SAME),
    "interrupt code": ("lcall _c_isr / mov _h,a / ret | _c_isr:inc _p / ret", SAME),
    "one that runs on into the next": ("lcall _c / mov _h,a / ret | _c:inc _p", SAME),
    "one that is run into": ("lcall _c / mov _h,a / ret | _b:inc _g | _c:inc _p / ret", SAME),
    "from one register bank to another": ("mov psw,#0x08 / lcall _c / mov psw,#0x00 / ret | _c:inc _p / ret", SAME),
    "one of another file with a variable of its own": (
        "lcall _c / mov dptr,#_x / movx a,@dptr / mov _h,a / ret || _c:mov dptr,#_z / movx @dptr,a / mov r7,a / add a,r7 / mov dptr,#_x / movx @dptr,a / ret",
        "_c = . / mov dptr,#_z / movx @dptr,a / mov r7,a / add a,r7 / mov dptr,#_x / movx @dptr,a / mov _h,a / ret"),
    "one whose variable has the name of another one here": (
        "lcall _c / mov _h,a / ret || _c:mov dptr,#_y / movx @dptr,a / ret", SAME),
    "a volatile variable of another file": (
        "lcall _c / mov _h,a / ret || _c:mov a,_k / mov a,_k / ret",
        "_c = . / mov a,_k / mov _h,_k / ret"),
}
COPIED = {  # _f_isr, _c_isr ...
    "small interrupt code called from several places": (
        "lcall _c / mov _h,a / ljmp _c | _c:mov a,_p / add a,_x / inc _p / ret | _other:lcall _c / 00101$: / sjmp 00101$",
        "; _c / mov a,_p / add a,_x / inc _p / mov _h,a / ; _c / inc _p / ret"),
    "interrupt code that is not small": (
        "lcall _c / mov _h,a / ljmp _c | _c:mov a,_p / " + "inc _p / " * 20 + "ret", SAME),
    "small interrupt code called from everywhere": (
        "lcall _c / " * 30 + "ret | _c:inc _p / inc _p / inc _p / inc _p / ret", "lcall _c / " * 29 + "ljmp _c"),
}
OTHER_HEAD = """
\t.globl _c
\t.area DSEG    (DATA)
_k:
\t.area XSEG    (XDATA)
_y:
_z:
\t.area CSEG    (CODE)
"""


def lines_of(code):
    return "".join(f"{line if line.endswith(':') else chr(9) + line}\n" for line in code.split(" / "))


def functions(codes):
    named = (code.partition(":") for code in codes)
    return "".join(f"{name}:\n" + lines_of(body) for name, _, body in named)


def tidied(code, folder, once, isr):
    here, _, there = code.partition(" || ")
    first, *others = here.split(" | ")
    if others and not once:
        others.append("_again:" + " / ".join(f"lcall {other.partition(':')[0]}" for other in others) + " / ret")
    files = Path(folder) / "x.asm", Path(folder) / "y.asm"
    files[0].write_text(HEAD + lines_of(first) + functions([*others, "_main:lcall _f / 00101$: / sjmp 00101$"]))
    files[1].write_text(OTHER_HEAD + "\tar0 = 0x00\n" + functions(filter(None, there.split(" | "))))
    if isr:
        files[0].write_text(re.sub(r"\b_(f|c|other)\b", r"_\1_isr", files[0].read_text()))
    program = Program(list(map(str, files)), {str(file): {"v", "w", "k"} for file in files})
    tidy(program)
    function = next(f for f in program.functions if f.name in ("_f", "_f_isr"))
    lines = [" ".join(line.text.split()) for line in function.lines if line.op or ";" in line.text or " = ." in line.text or
             line.label and line.label != function.name]
    return " / ".join(lines).replace("_isr", "" if isr else "_isr")


def main():
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, (code, wanted) in {**CASES, **CALLED_ONCE, **COPIED}.items():
            got, wanted = tidied(code, folder, name not in CASES, name in COPIED), wanted or code.split(" |")[0]
            failed += got != wanted
            print(f"{name}:{'PASS' if got == wanted else 'FAIL: ' + got + '     instead of ' + wanted}")
    print(f"-----------------------\n{len(CASES) + len(CALLED_ONCE) + len(COPIED)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
