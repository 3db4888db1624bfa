"""Blocks where they cost least.

  ljmp L ... behind some other jump: L: ... ret      L: ... ret, in the place of the jump
  a branch too long for what stands here instead     jz L / ljmp L1 / L: ... behind the end: L1: ... ljmp L
  of a call (inline.py)
"""
from asm import BRANCHES, ENDS, JUMPS, Line, instruction
from jumps import new_labels, size

REACH = 124  # octets, of a branch, to either side


def too_far(function):
    """Numbers of the lines that branch too far."""
    code, at = function.code, [0]
    for line in code:
        at.append(at[-1] + size(line))
    return [n for n, line in enumerate(code) if line.op in BRANCHES | {"sjmp"} and line.goes_to in function.labels and
            abs(at[function.labels[line.goes_to]] - at[n]) > REACH]


def branches_too_far(function):
    return sum(1 for n in too_far(function) if function.code[n].op != "sjmp")


def follow(function):
    """-> was a block moved to a jump that leads there?"""
    changed = False
    while any(_follow(function, line) for line in function.code):
        changed = True
    return changed


def _follow(function, line):
    if line.op not in JUMPS or line.goes_to not in function.labels or line in function.away:
        return False
    code = function.code
    start = function.labels[line.goes_to]
    while start and not code[start - 1].op:
        start -= 1
    if not start or code[start - 1].op not in ENDS:
        return False
    end = next((n for n in range(start, len(code)) if code[n].op in ENDS), None)
    if end is None or start <= code.index(line) <= end:
        return False
    first, last = function.lines.index(code[start]), function.lines.index(code[end])
    block = function.lines[first:last + 1]
    return _try(function, [line for line in function.lines if line not in block], line, block)


def _try(function, lines, line, block):
    """Put a block in the place of a line, unless that makes more branches too long."""
    before, far = function.lines, branches_too_far(function)
    at = lines.index(line)
    function.lines = lines[:at] + block + lines[at + 1:]
    function.refresh()
    if branches_too_far(function) <= far:
        return True
    function.lines = before
    function.refresh()
    return False


def stand_apart(function, line):
    """-> Does what a branch leads around, being too long, stand behind the end of the function now?"""
    before, lines, far = function.lines, function.lines, branches_too_far(function)
    first, last = lines.index(line) + 1, next(n for n, other in enumerate(lines) if other.label == line.goes_to)
    block = lines[first:last]
    if last < first or not any(is_name(other) for other in block) or function.code[-1].op not in ENDS:
        return False
    label = next(new_labels(function))
    back = [] if [other for other in block if other.op or other.label][-1].op in ENDS else [instruction("ljmp", line.goes_to)]
    function.lines = lines[:first] + [instruction("ljmp", label)] + lines[last:] + [Line(f"{label}:")] + block + back
    function.refresh()
    if branches_too_far(function) < far:
        return True
    function.lines = before
    function.refresh()
    return False


def is_name(line):
    """Does a function begin here that is one no more?"""
    return line.text.startswith("; _") or line.text.endswith(" = .")
