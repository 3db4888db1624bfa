"""Branches that what was put between has made too long for their eight bits.

  jz L                       jnz L1 / ljmp L / L1:
  cjne a,#x,L                cjne a,#x,L1 ... behind the nearest jump: L1: ljmp L
                             or, where none is near: cjne a,#x,L1 / sjmp L2 / L1: ljmp L / L2:
"""
from asm import BRANCHES, ENDS, Line, instruction
from inline import new_labels
from jumps import OPPOSITE, size

REACH = 124  # octets, to either side


def mend(function):
    """-> was anything too far?"""
    mended = False
    while _mend_one(function):
        function.refresh()
        mended = True
    return mended


def _mend_one(function):
    at = _addresses(function)
    for n, line in enumerate(function.code):
        if line.op in BRANCHES | {"sjmp"} and line.goes_to in function.labels and \
                abs(at[function.labels[line.goes_to]] - at[n]) > REACH:
            _mend(function, at, n, line)
            return True
    return False


def _addresses(function):
    """Of each line of code, at most, and of the end."""
    at = [0]
    for line in function.code:
        at.append(at[-1] + size(line))
    return at


def _mend(function, at, n, line):
    labels, far = new_labels(function), instruction("ljmp", line.goes_to)
    if line.op == "sjmp":
        function.put(line, far)
        return
    over, by = next(labels), next(labels)
    if line.op in OPPOSITE:
        function.put(line, instruction(OPPOSITE[line.op], *line.args[:-1], over), far, Line(f"{over}:"))
        return
    branch = instruction(line.op, *line.args[:-1], by)
    near = min((m for m, other in enumerate(function.code) if other.op in ENDS), key=lambda m: abs(at[m] - at[n]), default=n)
    if near != n and abs(at[near] - at[n]) < REACH - 8:
        place = function.code[near]
        function.put(line, branch)
        function.put(place, place, Line(f"{by}:"), far)
    else:
        function.put(line, branch, instruction("sjmp", over), Line(f"{by}:"), far, Line(f"{over}:"))
