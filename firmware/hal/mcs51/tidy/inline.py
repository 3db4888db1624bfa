"""A function that is called from one function alone stands where it was called.

  lcall _f                                     what _f does, a jump behind it in the place of each ret
  ljmp _f, of several the last                 what _f does; the others jump there

Saved are four cycles and two octets of stack, or two cycles; and what is known before the call is known in it. A callee is
itself done by then. Its name stays a symbol, `_f = .`: whoever looks for it in a map finds it. Small interrupt code is copied
to each place.

Calls stay where the other side of them matters: of what is written by hand, has its address taken or belongs to the port;
from one register bank to another; between interrupt code, whose name ends in _isr, and the rest (check_contexts.py).
"""
import re

from asm import BRANCHES, CALLS, ENDS, JUMPS, Line, instruction
from jumps import new_labels, size

LONGEST = 500  # lines of a function with all that stands in it
COPIED, COPIES = 40, 120  # octets of a function that is copied, and of all its copies but one


def inline(program, flow, caller):
    """-> does anything stand in the caller now that did not?"""
    if not caller.may_change() or caller.name == "_main":
        return False
    changed = False
    while True:
        callee, sites = next(_found(program, flow, caller), (None, None))
        if not callee:
            return changed
        last = program.named_in(callee.name) == {caller}
        name = program.moved(callee, caller) if last else program.copied(callee, caller)
        if last:
            flow.gone(callee)
        together = all(line.op in JUMPS for line in sites)
        for group in [sites] if together else [[line] for line in sites]:
            _put_in(caller, callee, group, [name] if last else None)
            last = False
        program.export(caller.path, [line.text.split()[0] for line in caller.lines if line.text.endswith(" = .")])
        flow.forget(caller)
        changed = True


def _found(program, flow, caller):
    """(callee, lines that call it or jump there) of each that can stand here"""
    for name in dict.fromkeys(line.goes_to for line in caller.code if line.op and flow.leaves(caller, line)):
        callee = program.resolve(caller, name)
        if not callee or not _movable(program, caller, callee):
            continue
        sites = [line for line in caller.code if name in line.args]
        if not any(line in caller.away for line in sites) and \
                all(line.args == (name,) and line.op in CALLS | JUMPS for line in sites) and \
                (_only_here(program, caller, name, sites) or _is_small(program, callee)) and program.show(callee, caller.path):
            yield callee, sites


def _only_here(program, caller, name, sites):
    calls = [line for line in sites if line.op in CALLS]
    return program.named_in(name) == {caller} and len(calls) * len(sites) <= 1


def _is_small(program, callee):
    """Interrupt code that may be copied"""
    octets = sum(map(size, callee.code))
    sites = sum(1 for f in program.named_in(callee.name) if f for line in f.code if callee.name in line.args)
    return callee.name.endswith("_isr") and octets <= COPIED and (octets - 3) * (sites - 1) <= COPIES


def _movable(program, caller, callee):
    return callee is not caller and callee.may_change() and not callee.interrupt and callee.name != "_main" and \
        callee.name not in program.taken and program.is_one(callee) and "/hal/mcs51/" not in callee.path and \
        callee.bank == caller.bank and callee.name.endswith("_isr") == caller.name.endswith("_isr") and \
        callee.code[-1].op in ENDS and len(callee.code) + len(caller.code) < LONGEST and \
        not any(line.op in BRANCHES and not line.goes_to.endswith("$") for line in callee.code)


def _put_in(caller, callee, sites, symbols):
    """symbols: what says where the callee was, if that is here; then so do those of others that stand in it"""
    labels = new_labels(caller)
    names = {old: next(labels) for old in callee.labels}
    begin, end = next(labels), next(labels)
    *others, last = sites
    for line in others:
        caller.put(line, instruction("ljmp", begin))
    body = [Line(f"{begin}:")] * bool(others) + (symbols or [Line(f"; {callee.name}")])
    for line in callee.lines:
        if line.op or line.label in names:
            line = Line(re.sub(r"\b\d+\$", lambda found: names[found[0]], line.text.split(";")[0]))
            body += _back(line, end) if last.op in CALLS else [line]
        elif symbols and line.text.endswith(" = ."):
            body.append(line)
    caller.put(last, *body, *[Line(f"{end}:")] * (last.op in CALLS))
    caller.refresh()


def _back(line, end):
    """What a line becomes where control is to go on at a label in the place of a return."""
    if line.op == "ret":
        return [instruction("ljmp", end)]
    if line.op in JUMPS and not line.goes_to.endswith("$"):
        return [instruction("lcall", line.goes_to), instruction("ljmp", end)]
    return [line]
