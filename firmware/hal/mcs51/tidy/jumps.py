"""Ways through a function: the same instructions, reached with fewer jumps.

  lcall f / ret                              ljmp f            and two octets of stack less
  a jump to a jump, to ret, to the next      where that leads, ret, nothing
  jz L1 / sjmp L2 / L1:                      jnz L2
  what no way leads to, a label no one names gone

An interrupt function keeps its ret, and what SDCC puts around it.
"""
from asm import BRANCHES, CALLS, ENDS, JUMPS, Line, instruction

OPPOSITE = {"jz": "jnz", "jnz": "jz", "jc": "jnc", "jnc": "jc", "jb": "jnb", "jnb": "jb"}
REACH = 120  # of a relative jump, with something in hand
THREE = {"ljmp", "lcall", "cjne", "jb", "jnb", "jbc"}


def size(line):
    """Octets of an instruction, at most."""
    op, args = line.op, line.args
    if not op:
        return 0
    if op in THREE or args[:1] == ("dptr",) and op == "mov":
        return 3
    if op in ("jz", "jnz", "jc", "jnc", "sjmp", "ajmp", "acall", "push", "pop"):
        return 2
    direct = [a for a in args if not (a in ("a", "c", "ab", "dptr") or a[0] == "@" or len(a) == 2 and a[0] == "r")]
    return 1 + len(direct)


def new_labels(function):
    number = max((int(label[:-1]) for label in function.labels), default=100)
    while True:
        number += 1
        yield f"{number:05d}$"


class Ways:
    def __init__(self, function):
        self.function = function

    def run(self):
        changed = False
        while any(self._change(n) for n in range(len(self.function.code))):
            self.function.refresh()
            changed = True
        return changed

    def _behind(self, n):
        """-> the first instruction from n on, the labels before it"""
        code, labels = self.function.code, []
        while n < len(code) and not code[n].op:
            labels.append(code[n].label)
            n += 1
        return (code[n] if n < len(code) else Line("")), labels

    def _change(self, n):
        function, line = self.function, self.function.code[n]
        if line in function.away:
            return False
        if line.label:
            return self._unnamed(line)
        following, labels = self._behind(n + 1)
        if line.op in ENDS and following.op and not labels:
            function.drop(following)
        elif line.op in CALLS and following.op == "ret" and not function.interrupt and line.args[0].startswith("_"):
            function.put(line, instruction("ljmp", line.args[0]))
        elif line.op in JUMPS | BRANCHES and line.goes_to in function.labels:
            return self._jump(n, line, following, labels)
        else:
            return False
        return True

    def _unnamed(self, line):
        if not line.label.endswith("$") or line.op or any(line.label in other.args for other in self.function.code):
            return False
        self.function.drop(line)
        return True

    def _jump(self, n, line, following, labels):
        function, target = self.function, line.goes_to
        if line.op in JUMPS and target in labels:
            function.drop(line)
            return True
        there, _ = self._behind(function.labels[target])
        if line.op in JUMPS and there.op == "ret":
            function.put(line, instruction("ret"))
        elif there.op in JUMPS and there.goes_to != target and there is not line and self._can(n, line, there.goes_to):
            function.put(line, instruction("ljmp" if line.op in JUMPS else line.op, *line.args[:-1], there.goes_to))
        elif line.op == "ljmp" and self._reaches(n, target):
            function.put(line, instruction("sjmp", target))
        elif line.op in OPPOSITE and target not in labels and following.op in JUMPS and not labels \
                and following.goes_to in function.labels and self._skips(n, target) and self._reaches(n, following.goes_to):
            function.drop(following)
            function.put(line, instruction(OPPOSITE[line.op], *line.args[:-1], following.goes_to))
        else:
            return False
        return True

    def _skips(self, n, target):
        """Does the branch lead just behind the jump that follows it?"""
        following = self.function.code[n + 1:]
        return target in self._behind(n + 1 + next(i for i, line in enumerate(following) if line.op) + 1)[1]

    def _can(self, n, line, target):
        if target in self.function.labels:
            return line.op == "ljmp" or self._reaches(n, target)
        return line.op in JUMPS

    def _reaches(self, n, target):
        first, last = sorted((n, self.function.labels[target]))
        return sum(map(size, self.function.code[first:last + 1])) < REACH
