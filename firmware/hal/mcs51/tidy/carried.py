"""A value that ways carry to a label in a register, to be put elsewhere there, is put there at once.

  mov dpl,#1 / sjmp L ... mov dpl,r6 / L: mov _g,dpl          mov _g,#1 / sjmp L ... mov _g,r6 / L:

where every way to L sets the register last, and nobody wants it behind L.
"""
from asm import BIT, BRANCHES, ENDS, JUMPS, cell, instruction

CARRIERS = ["dpl"] + [f"r{n}" for n in range(8)]


def put_at_once(program, flow, function):
    """-> was anything?"""
    changed = False
    while any(_put(program.plain[function.path], flow, function, n) for n, line in enumerate(function.code)
              if line.op == "mov" and line.args[1] in CARRIERS and n and not function.code[n - 1].op):
        changed = True
    return changed


def _put(plain, flow, function, n):
    line = function.code[n]
    to, carrier = line.args
    where = cell(to)
    if line in function.away or not (to == "a" or to in CARRIERS or where and plain.get(where[0]) in ("DSEG", "OSEG")):
        return False
    setters = _setters(function, n, carrier)
    if not setters or not all(_legal(to, setter.args[1]) for setter in setters) or \
            flow.live(function, flow.wanted[function])[n + 1] & BIT[carrier]:
        return False
    function.drop(line)
    for setter in setters:
        source = setter.args[1]
        function.put(setter, *[instruction("mov", to, source)] * (source != to))
    function.refresh()
    return True


def _setters(function, n, carrier):
    """The `mov carrier,X` that every way to the labels before a line ends with; None: not every one does."""
    code, labels, start = function.code, set(), n
    while start and not code[start - 1].op:
        start -= 1
        labels.add(code[start].label)
    ends = [m for m, line in enumerate(code) if line.op in JUMPS | BRANCHES and line.goes_to in labels]
    if not start or any(not label.endswith("$") for label in labels) or any(code[m].op in BRANCHES for m in ends):
        return None
    setters = [code[m - 1] for m in ends] + [code[start - 1]] * (code[start - 1].op not in ENDS)
    good = all(line.op == "mov" and line.args[0] == carrier and line not in function.away for line in setters)
    return list(dict.fromkeys(setters)) if good else None


def _legal(to, source):
    return not (to[0] == "r" and (source in CARRIERS[1:] or source[0] == "@")) and not (source[0] == "@" and to == source)
