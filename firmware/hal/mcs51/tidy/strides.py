"""A pointer some octets on is added up, not counted: six cycles instead of four and two an octet.

    mov dpl,X / mov dph,Y / inc dptr ...         mov a,X / add a,#n / mov dpl,a / clr a / addc a,Y / mov dph,a

Done last, where A and the flags are free: in interrupt code from three octets on, elsewhere where it is no longer.
"""
from asm import A, C, F, cell, instruction

FROM = {True: 3, False: 5}


def add_up(program, flow, function):
    plain = program.plain[function.path]
    live = flow.live(function, flow.wanted[function])
    for n in range(len(function.code) - 2, -1, -1):
        low, high = function.code[n:n + 2]
        if not (low.op == high.op == "mov" and low.args[0] == "dpl" and high.args[0] == "dph") or low in function.away:
            continue
        steps = n + 2
        while steps < len(function.code) and function.code[steps].same("inc", "dptr"):
            steps += 1
        count, x, y = steps - n - 2, low.args[1], high.args[1]
        if count < FROM[function.name.endswith("_isr")] or live[steps] & (A | C | F) or not _simple(plain, y) or \
                not (x == "a" or _simple(plain, x)):
            continue
        for line in function.code[n + 1:steps]:
            function.drop(line)
        function.put(low, *[instruction("mov", "a", x)] * (x != "a"), instruction("add", "a", f"#0x{count:02x}"),
                     instruction("mov", "dpl", "a"), instruction("clr", "a"), instruction("addc", "a", y),
                     instruction("mov", "dph", "a"))
    function.refresh()


def _simple(plain, operand):
    """A register of the bank, or a variable."""
    return len(operand) == 2 and operand[0] == "r" or cell(operand) and cell(operand)[0] in plain
