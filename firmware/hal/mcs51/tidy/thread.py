"""Ways past a test whose outcome is known on them: what lies before the test is done where the way comes from.

  mov dpl,#0 / sjmp L ... L: mov a,dpl / jz M          mov dpl,#0 / mov a,dpl / sjmp M

and what then nobody reads is not done at all (unread.py). The result of a function that has been put in the place of its
call (inline.py) is not made, fetched and looked at: the way leads to where it would.
"""
from asm import BRANCHES, CALLS, ENDS, JUMPS, Line, instruction
from jumps import new_labels, size
from known import Follower

MOST = 30   # ways of a function
OCTETS = 10  # before the test


class Threads(Follower):
    def run(self):
        done = 0
        while done < MOST and self._once():
            done += 1
        return done > 0

    def _once(self):
        self.__init__(*self.of)
        self.found = None
        self.walk(self._look)
        if not self.found:
            return False
        line, lines, branch = self.found
        keeps = [line] * (line.op not in JUMPS)
        self.function.put(line, *keeps, *lines, instruction("ljmp", self._leads_to(branch)))
        self.function.refresh()
        return True

    def __init__(self, program, flow, function, own):
        super().__init__(program, flow, function, own)
        self.of = program, flow, function, own

    def _look(self, line):
        """Does the line jump, or run on, to a label whose test is known here?"""
        if not self.found:
            if line.op in JUMPS and line.goes_to in self.function.labels:
                self._follow(line, self.function.labels[line.goes_to], Follower.ahead(self, []))
            elif line.op not in ENDS:
                behind = self.function.code.index(line) + 1
                if behind < len(self.function.code) and self.function.code[behind].label:
                    self._follow(line, behind, self.ahead([line]))
        return [line]

    def _follow(self, line, n, known):
        now, self.now, lines = self.now, known, []
        for other in self.function.code[n:]:
            if other.op in BRANCHES:
                taken = self.outcome(other)
                if taken is not None and (taken or other is not line):
                    if other.op == "cjne":  # it says which is less, too
                        less = self.value(other.args[0]) < self.value(other.args[1])
                        lines.append(instruction("setb" if less else "clr", "c"))
                    self.found = line, lines, (other, taken)
                break
            if other.op in ENDS | CALLS or other in self.function.away or sum(map(size, lines)) > OCTETS or \
                    other.op in ("push", "pop"):
                break
            if other.op:
                lines.append(Line(f"\t{other.text.split(';')[0].strip()}"))
                self.step(other)
        self.now = now

    def _leads_to(self, branch):
        line, taken = branch
        if taken:
            return line.goes_to
        label = next(new_labels(self.function))
        self.function.put(line, line, Line(f"{label}:"))
        return label
