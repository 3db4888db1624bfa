"""Who reads what afterwards: liveness of registers over the whole program, and of a function's own memory.

A function's summary, from its own instructions and those it calls:

  reads     registers whose value at the call it may use
  sets      registers that hold something new on each way back
  changes   registers that may hold something new

A routine of the library, or one that calls itself, may do anything. What a function leaves behind is wanted if it is
wanted after one of its calls; of a function whose address is taken, the result. An interrupt leaves all as it was.
"""
from asm import ALL, BANK, BRANCHES, C, CALLS, ENDS, JUMPS, RESULT

ANYTHING = (RESULT | C, 0, ALL)
NEVER_RETURNS = {"_hal_reset": (RESULT, ALL, ALL)}


class Flow:
    def __init__(self, program):
        self.program = program
        self.summaries, self.active = {}, set()
        for f in program.functions:
            self.summary(f)
        self.wanted = {f: 0 for f in program.functions}
        self._find_wanted()

    def forget(self, function):
        """It has changed; it wants less than before, so what others know of it stays true but for the registers it uses."""
        self.summaries.pop(function, None)
        self.summary(function)

    def gone(self, function):
        """It stands in the place of its call now."""
        self.summaries.pop(function, None)
        del self.wanted[function]

    # ---- calls ----

    def callee(self, function, line):
        return self.program.resolve(function, line.goes_to)

    def summary_of_call(self, function, line):
        found = self.callee(function, line)
        return self.summary(found) if found else ANYTHING

    def summary(self, function):
        if function.name in NEVER_RETURNS:
            return NEVER_RETURNS[function.name]
        if function in self.active:
            return ALL, 0, ALL
        if function not in self.summaries and function.code:
            self.active.add(function)
            changes = 0
            for line in function.code:
                changes |= self.changed_by(function, line)
                if line.op in JUMPS | BRANCHES and self.leaves(function, line):
                    changes |= self.summary_of_call(function, line)[2]
            if self.runs_on(function):
                changes = ALL
            least, most = self.live(function, 0), self.live(function, ALL)
            first = least[0] if least else ALL
            self.summaries[function] = first, ALL & ~(most[0] if most else ALL), changes
            self.active.discard(function)
        return self.summaries[function]

    def leaves(self, function, line):
        """Does it call, or jump to another function?"""
        target = line.goes_to
        return target is not None and (line.op in CALLS or not target.endswith("$"))

    @staticmethod
    def runs_on(function):
        last = function.code[-1]
        return last.op not in ENDS

    def changed_by(self, function, line):
        changed = line.writes | (self.summary_of_call(function, line)[2] if line.op in CALLS else 0)
        return changed & ~BANK if line in function.away else changed

    # ---- inside a function ----

    def after(self, function, n, live, at_end):
        """What is wanted behind the n-th instruction. live: what is wanted before each; at_end: when it returns"""
        line = function.code[n]
        op, target = line.op, line.goes_to
        if op == "reti":
            return (ALL & ~BANK if function.naked else ALL) | at_end
        if op == "ret":
            return at_end
        wanted = 0
        if op in JUMPS | BRANCHES:
            if target.endswith("$"):
                wanted |= live[function.labels[target]] if target in function.labels else ALL
            else:
                reads, sets, _ = self.summary_of_call(function, line)
                wanted |= reads | (at_end & ~sets)
        if op == "jmp":
            for at in function.labels.values():
                wanted |= live[at]
            wanted |= RESULT | at_end
        if op not in ENDS:
            wanted |= live[n + 1] if n + 1 < len(function.code) else ALL
        return wanted

    def live(self, function, at_end, memory=None):
        """-> what is wanted before each line of code. memory: {line: (cells it reads, cells it sets)} as bits above ALL"""
        code = function.code
        live = [0] * (len(code) + 1)
        memory = memory or {}
        again = True
        while again:
            again = False
            for n in range(len(code) - 1, -1, -1):
                line = code[n]
                wanted = self.after(function, n, live, at_end)
                wanted = self._before(function, line, wanted, memory.get(line, (0, 0)))
                if wanted | live[n] != live[n]:
                    live[n] |= wanted
                    again = again or line.label is not None
        return live

    def _before(self, function, line, wanted, memory):
        if not line.op:
            return wanted
        if line in function.switches and line not in function.away:
            # a call in another bank ends, or an interrupt function begins or ends
            wanted = wanted if self._comes_back(function, line) else wanted & ~BANK
        reads, sets = line.reads, line.writes
        if sets == ALL or "." in "".join(line.args[:1]):
            sets = 0
        if line.op in CALLS:
            callee_reads, callee_sets, _ = self.summary_of_call(function, line)
            reads, sets = reads | callee_reads, sets | callee_sets
        if line in function.away:
            reads, sets = (reads & ~BANK if line.op in CALLS else reads), sets & ~BANK
        return (wanted & ~sets & ~memory[1]) | reads | memory[0]

    @staticmethod
    def _comes_back(function, line):
        before = function.code[function.code.index(line) - 1]
        return before in function.away or not any(s.op == "mov" for s in function.switches)

    # ---- over the program ----

    def _find_wanted(self):
        for name in self.program.taken:
            for f in self.program.functions:
                if f.name == name:
                    self.wanted[f] |= RESULT
        work = set(self.program.functions)
        while work:
            f = work.pop()
            live = None
            for n, line in enumerate(f.code):
                if not line.op or not self.leaves(f, line):
                    continue
                if live is None:
                    live = self.live(f, self.wanted[f])
                callee = self.callee(f, line)
                if callee is None:
                    continue
                wanted = self.wanted[f] if line.op not in CALLS else live[n + 1] if n + 1 < len(f.code) else ALL
                if line in f.away:
                    wanted &= ~BANK
                if self.wanted[callee] | wanted != self.wanted[callee]:
                    self.wanted[callee] |= wanted
                    work.add(callee)
            if self.runs_on(f):
                following = self.program.functions[(self.program.functions.index(f) + 1) % len(self.program.functions)]
                self.wanted[following] |= ALL
                work.add(following)
