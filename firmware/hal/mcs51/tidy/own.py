"""Memory that is one function's own: its locals and temporaries, which SDCC gives a place in RAM and a name each.

Own is what no other function, table or start-up code names and whose address goes nowhere: DPTR is loaded with it, perhaps
counted up, and used by movx at a place that is known. So nothing but the instructions that name it reach it: not a call,
not a store through a pointer. A local static variable looks the same, but is wanted when the function begins.
"""
import re

from asm import BRANCHES, CALLS, DPH, DPL, DPTR, ENDS, JUMPS, LOCAL, RETURNS, cell
from known import Follower

NAME = re.compile(r"_\w+")


def own_memory(program, flow, function):
    """-> {symbol} after every movx of the function has got its `where`"""
    Follower(program, flow, function, set()).walk(lambda line: [line])
    mine = {n for n in named(function.code) if LOCAL.match(n) and program.plain[function.path].get(n) in ("XSEG", "DSEG", "OSEG", "BSEG")
            and program.named_in(n) == {function}}
    for line in function.code:
        for operand in line.args:
            if operand.startswith("#") and not line.same("mov", "dptr", operand):
                mine -= set(NAME.findall(operand))
    return mine - _escaping(flow, function, mine)


def named(lines):
    return {n for line in lines for operand in line.args for n in NAME.findall(operand)}


def _escaping(flow, function, mine):
    """Symbols whose address, or half of it, is in DPTR when anything but a movx to a known place uses that."""
    code = function.code
    held, work, escaped = [set() for _ in range(len(code) + 1)], list(range(len(code))), set()
    while work:
        n = work.pop(0)
        line, now = code[n], held[n]
        used = _used(flow, function, line)
        escaped |= {symbol for symbol, half in now if half & used}
        changed = flow.changed_by(function, line) if line.op in CALLS else line.writes
        after = now if line.same("inc", "dptr") else {(symbol, half) for symbol, half in now if not half & changed}
        if line.op == "mov" and line.args[0] == "dptr":
            after = {(symbol, half) for symbol in mine & set(NAME.findall(line.args[1])) for half in (DPL, DPH)}
        following = [n + 1] if line.op not in ENDS else []
        if line.op in JUMPS | BRANCHES and line.goes_to in function.labels:
            following.append(function.labels[line.goes_to])
        for other in following:
            if not after <= held[other]:
                held[other] |= after
                work.append(other)
    return escaped


def _used(flow, function, line):
    """DPL and DPH, as far as an instruction uses them in a way that is not followed."""
    if not line.op or line.same("inc", "dptr") or line.op == "movx" and line.where:
        return 0
    if line.op in RETURNS:
        return flow.wanted[function] if line.op == "ret" else DPTR
    if flow.leaves(function, line):
        return flow.summary_of_call(function, line)[0] | (flow.wanted[function] if line.op not in CALLS else 0)
    return line.reads


class Cells:
    """Bits above the registers' for the cells of own memory, for Flow.live()"""

    def __init__(self, flow, function, own):
        self.bits, self.own, self.memory = {}, own, {}
        for line in function.code:
            self.memory[line] = self._effect(line) if line.op else (0, 0)

    def _bit(self, where):
        return 1 << 16 + self.bits.setdefault(where, len(self.bits))

    def _effect(self, line):
        reads = sets = 0
        if line.op == "movx" and line.where and line.where[0] in self.own:
            bit = self._bit(line.where)
            return (bit, 0) if line.args[0] == "a" else (0, bit)
        for place, operand in enumerate(line.args):
            where = cell(operand.lstrip("/"))
            if where and where[0] in self.own:
                if place == 0 and line.op in ("mov", "pop", "setb", "clr"):
                    sets |= self._bit(where)
                else:
                    reads |= self._bit(where)
        return reads, sets

    def all(self):
        return sum(1 << 16 + n for n in self.bits.values())


def live_with_cells(flow, function, cells):
    """-> what is wanted before each line. What is wanted when the function begins is static: it is wanted at the end, too"""
    at_end = flow.wanted[function]
    while True:
        live = flow.live(function, at_end, cells.memory)
        static = live[0] & cells.all()
        if static | at_end == at_end:
            return live
        at_end |= static
