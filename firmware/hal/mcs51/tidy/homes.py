"""Locals in registers that calls leave alone.

An octet of a function's own memory moves into a register that is free all the while it is wanted.

    mov dptr,#_f_x_65536_1 / movx @dptr,a        mov r3,a
    mov dptr,#_f_x_65536_1 / movx a,@dptr        mov a,r3

Free is a register that is not wanted behind any instruction where the octet is (of the callers neither, Flow.wanted), and
that no instruction there changes, a call included. Callees are done before their callers, so what they change is known.
An interrupt function keeps its octets: it would have to save the register.

A register that is saved around a call becomes, all through the function, one that neither it nor its calls use:

    push ar7 / lcall _g / pop ar7                push ar3 / lcall _g / pop ar3           which then is not worth its while
"""
import re

from asm import BANK, BIT, Line, instruction
from own import Cells, live_with_cells

REGISTERS = [f"r{n}" for n in (2, 3, 4, 5, 6, 7, 1, 0)]


def find_homes(program, flow, function, own):
    """-> did any move?"""
    own = {name for name in own if program.plain[function.path][name] == "XSEG"}  # direct RAM is good enough
    if function.interrupt or function.name == "_main" or not own:
        return False
    moved = False
    while True:
        cells = Cells(flow, function, own)
        live = live_with_cells(flow, function, cells)
        static = live[0]
        for where in sorted(cells.bits, key=lambda w: (-_uses(cells, w), w)):
            bit = 1 << 16 + cells.bits[where]
            home = None if bit & static else _free(flow, function, cells, live, bit)
            if home:
                _move(function, cells, bit, home)
                function.refresh()
                moved = True
                break
        else:
            return moved


def _uses(cells, where):
    bit = 1 << 16 + cells.bits[where]
    return sum(1 for reads, sets in cells.memory.values() if (reads | sets) & bit)


def _free(flow, function, cells, live, bit):
    taken = flow.wanted[function] & BANK
    for n, line in enumerate(function.code):
        if not line.op:
            continue
        reads, sets = cells.memory[line]
        if sets & bit:
            taken |= live[n + 1]
            continue
        if live[n + 1] & bit or _there(function, line, live) & bit:
            taken |= live[n + 1] | _there(function, line, live) | flow.changed_by(function, line)
    return next((r for r in REGISTERS if not taken & BIT[r]), None)


def _there(function, line, live):
    return live[function.labels[line.goes_to]] if line.goes_to in function.labels else 0


def _move(function, cells, bit, home):
    for line, (reads, sets) in cells.memory.items():
        if (reads | sets) & bit:
            function.put(line, instruction("mov", *((home, "a") if sets else ("a", home))))


def find_safer(flow, function):
    """-> was a register that is saved around calls renamed?"""
    if function.interrupt or function.name == "_main":
        return False
    saved = {line.args[0][1:] for line in function.code if line.op == "push" and re.match(r"ar[2-7]$", line.args[0])}
    renamed = False
    for name in sorted(saved):
        used, fixed = _used_and_fixed(flow, function)
        other = next((r for r in REGISTERS[:6] if not (used | fixed) & BIT[r]), None)
        if not other or fixed & BIT[name]:
            continue
        for line in function.code:
            if re.search(rf"\ba?{name}\b", line.text.split(";")[0]):
                function.put(line, Line(re.sub(rf"\b(a?){name}\b", rf"\1{other}", line.text.split(";")[0])))
        function.refresh()
        renamed = True
    return renamed


def _used_and_fixed(flow, function):
    """Registers that the function or one it calls uses; those that callers or callees mean by their number."""
    live = flow.live(function, flow.wanted[function])
    used, fixed = 0, flow.wanted[function] | live[0]
    for n, line in enumerate(function.code):
        used |= line.reads | flow.changed_by(function, line)
        if line.op and flow.leaves(function, line):
            fixed |= flow.summary_of_call(function, line)[0] | flow.changed_by(function, line) & live[n + 1]
    return used, fixed
