#!/usr/bin/env python3
"""Prove from SDCC's assembly that interrupts and the main loop do not meet in a function's static locals.

usage: check_contexts.py FILE.asm ...

On the 8051 the locals of a function are static memory. A function that the main loop is in while an interrupt
calls it is corrupted, and no tool says so. The names carry the context (house rule: interrupt code ends in
_isr), so the rules can be checked call by call, on what the compiler made of the source (asm51.py; a jump to another
function or running on into it is a call like any other):

  1  interrupt code (*_isr) calls interrupt code, the services in ALLOWED, and bare functions; nothing else. A bare
     function calls nothing and uses no register and no memory of its own: it only sets variables to constants;
  2  interrupt code calls none of SDCC's helpers (__mulint, __divuint, __gptrget ...): some are not reentrant, and
     all cost more than an octet interrupt has;
  3  other code calls interrupt code only while interrupts are masked: on every path through the function there
     are more hal_irq_save() than hal_irq_restore() calls before it; a function returns with as many as it took;
  4  a function called through a pointer is interrupt code if and only if its caller is;
  5  no variable of interrupt code is overlaid with another function's (area OSEG);
  6  interrupt code does not select register bank 0 for anybody: that is the main loop's, and SDCC selects it for a
     function without IN_ISR, REENTRANT or not.

By 1, 3 and 4 the functions reachable from interrupts and those reachable from unmasked main code are disjoint.
check_image.py follows the calls of linked images once more, from their vectors.
"""
import re
import sys

from asm51 import Program

# Services of the port that interrupt code may call and main may call only under the lock (hal.h).
ALLOWED = {"hal_silence", "hal_silent", "hal_send"}
# May be called from anywhere: it does not return.
ANYWHERE = {"hal_reset"}
LOCK, UNLOCK = "hal_irq_save", "hal_irq_restore"


def is_interrupt(name):
    return name.endswith("_isr") or name in ALLOWED


def lock_depths(function):
    """-> {index: possible numbers of saved interrupt masks when the instruction starts}"""
    made = dict(function.calls())
    depths = {0: {0}}
    work = [(0, 0)]
    while work:
        index, depth = work.pop()
        if index >= len(function.code):
            continue
        after = depth + {LOCK: 1, UNLOCK: -1}.get(made.get(index), 0)
        if after < 0 or after > 8:
            after = max(0, min(after, 8))
        for following in function.successors(index):
            if after not in depths.setdefault(following, set()):
                depths[following].add(after)
                work.append((following, after))
    return depths


def is_bare(function):
    """Safe in any context: variables set to constants, and return."""
    for op, operands in function.code:
        if op not in ("ret", "clr", "setb", "mov") or f"_{function.name}_" in operands:
            return False
        if re.search(r"@|\b(a|b|c|ab|acc|psw|sp|dptr|dpl|dph|a?r[0-7])\b", operands):
            return False
        if op == "mov" and ",#" not in operands.replace(" ", ""):
            return False
    return bool(function.code)


def is_stateless(function):
    """Calls nothing, keeps nothing: works with A and carry alone, which whoever breaks in saves."""
    return not any(function.calls()) and all(
        op in ("ret", "clr", "setb", "cpl", "mov", "anl", "orl", "jb", "jnb") and f"_{function.name}_" not in operands and
        not re.search(r"@|\b(b|dptr|dpl|dph|a?r[0-7])\b", operands) for op, operands in function.code)


def check_calls(function, handlers, bare):
    """Rules 1 to 4 for one function."""
    inside = is_interrupt(function.name)
    depths = lock_depths(function)
    for index, callee in function.calls():
        if callee is None:
            wrong = sorted(h.name for h in handlers if is_interrupt(h.name) != inside)
            if wrong:
                yield f"calls through a pointer, which may be {', '.join(wrong)}"
            elif inside and not handlers:
                yield "calls through a pointer, and no function's address is taken"
        elif callee in ANYWHERE or callee in bare:
            continue
        elif inside and callee.startswith("_"):
            yield f"calls SDCC's helper {callee}"
        elif inside and not is_interrupt(callee):
            yield f"calls {callee}, which is not interrupt code"
        elif not inside and is_interrupt(callee) and 0 in depths.get(index, {0}):
            yield f"calls {callee} with interrupts on"


def check_returns(function):
    """A function gives back as many locks as it took."""
    if LOCK not in {callee for _, callee in function.calls()} or function.name in (LOCK, UNLOCK):
        return
    depths = lock_depths(function)
    for index, (op, operands) in enumerate(function.code):
        leaves = op in ("ret", "reti") or (op in ("ljmp", "ajmp") and operands.startswith("_"))
        given_back = 1 if operands == "_" + UNLOCK else 0
        if leaves and max(depths.get(index, {0})) - given_back > 0:
            yield "returns with interrupts masked"


def check_bank(function, bare):
    """Rule 6."""
    made = dict(function.calls())
    for index, (op, operands) in enumerate(function.code):
        if op == "mov" and operands.replace(" ", "") == "psw,#0x00" and is_interrupt(function.name):
            callee = made.get(index + 1)
            if callee not in ANYWHERE and callee not in bare:
                yield f"selects the main loop's registers for {callee}"


def check(program):
    bare = {f.name for f in program.functions if is_bare(f)} - {f.name for f in program.functions if not is_bare(f)}
    for function in program.functions:
        problems = [*check_calls(function, program.handlers, bare), *check_returns(function), *check_bank(function, bare)]
        for problem in problems:
            yield f"{function.path}: {function.name}: {problem}"
    for path, source in program.sources.items():
        for variable in source.overlaid:
            if any(is_interrupt(f.name) and variable.startswith(f.name + "_") for f in source.functions):
                yield (f"{path}: {variable}: a variable of interrupt code is overlaid with others "
                       "(compile with --nooverlay)")


def main(paths):
    program = Program(paths)
    problems = list(check(program))
    good = f"contexts: {len(program.functions)} functions in {len(paths)} files keep apart"
    print("\n".join(problems) if problems else good)
    if not program.functions:
        print("contexts: nothing to check")
    return 1 if problems or not program.functions else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
