"""Branches that what was put between has made too long for their eight bits.

  jz L                       jnz L1 / ljmp L / L1:
  cjne a,#x,L                cjne a,#x,L1 ... behind the nearest jump: L1: ljmp L
                             or, where none is near: cjne a,#x,L1 / sjmp L2 / L1: ljmp L / L2:
"""
from asm import ENDS, Line, instruction
from jumps import OPPOSITE, new_labels, size
from place import REACH, stand_apart, too_far


def mend(function):
    """-> was anything too far?"""
    mended = False
    while _mend_one(function):
        function.refresh()
        mended = True
    return mended


def _mend_one(function):
    far = too_far(function)
    if not far:
        return False
    line = function.code[far[0]]
    if line.op == "sjmp" or not stand_apart(function, line):
        _mend(function, line)
    return True


def _mend(function, line):
    labels, far = new_labels(function), instruction("ljmp", line.goes_to)
    if line.op == "sjmp":
        function.put(line, far)
        return
    over, by = next(labels), next(labels)
    if line.op in OPPOSITE:
        function.put(line, instruction(OPPOSITE[line.op], *line.args[:-1], over), far, Line(f"{over}:"))
        return
    branch = instruction(line.op, *line.args[:-1], by)
    place = _behind_a_jump(function, line)
    if place:
        function.put(line, branch)
        function.put(place, place, Line(f"{by}:"), far)
    else:
        function.put(line, branch, instruction("sjmp", over), Line(f"{by}:"), far, Line(f"{over}:"))


def _behind_a_jump(function, branch):
    """The nearest line that nothing runs on from, if a branch reaches so far."""
    code = function.code
    here = code.index(branch)
    near = min((m for m, line in enumerate(code) if line.op in ENDS), key=lambda m: abs(m - here), default=None)
    if near is None or sum(map(size, code[min(here, near):max(here, near) + 1])) > REACH - 8:
        return None
    return code[near]
