"""What nobody reads afterwards is not written: registers, and memory that is a function's own.

  a register, or an own place, written and not read     nothing
  a variable that is set, and at once set again         nothing the first time
  mov R,X ... add a,R and R not read any more           add a,X
  mov a,X / mov Y,a and A not read any more             mov Y,X
  push X ... pop X with X unchanged between             nothing
"""
from asm import A, BIT, BRANCHES, C, CALLS, ENDS, F, cell, instruction, register, unknown
from own import Cells, live_with_cells

NO_EFFECT = {"mov", "movx", "movc", "add", "addc", "subb", "anl", "orl", "xrl", "inc", "dec", "clr", "setb", "cpl", "swap",
             "rl", "rr", "rlc", "rrc", "mul", "div", "da"}
AHEAD = 6


class Unread:
    def __init__(self, program, flow, function, own):
        self.plain, self.flow, self.function, self.own = program.plain[function.path], flow, function, own

    def run(self):
        changed = False
        while self._once():
            changed = True
        return changed

    def _once(self):
        function = self.function
        cells = Cells(self.flow, function, self.own)
        live = live_with_cells(self.flow, function, cells)
        ours = [n for n, line in enumerate(function.code)
                if line.op and not line.label and line not in function.away and line not in function.switches]
        unread = [function.code[n] for n in ours if self._is_overwritten(n) or
                  self._is_unread(function.code[n], live[n + 1], cells.memory[function.code[n]])]
        for line in unread:
            function.drop(line)
        changed = unread or any(self._passed_on(n, live) or self._saved_for_nothing(n, live) for n in reversed(ours))
        if changed:
            function.refresh()
        return changed

    def _is_unread(self, line, wanted, memory):
        if line.op not in NO_EFFECT or any(self._port(operand) for operand in line.args):
            return False
        first = line.args[0]
        own = memory[1] or (cell(first) or ("",))[0] in self.own
        if own:
            return not memory[1] & wanted and memory[1] != 0
        if line.op == "movx" and not line.where:
            return False
        elsewhere = first.startswith("@") or not line.writes and not first == "ab"
        return not elsewhere and not line.writes & wanted

    def _is_overwritten(self, n):
        """A variable in direct RAM is set, and set again, with nothing between that might read it."""
        line = self.function.code[n]
        where = cell(line.args[0]) if line.op == "mov" else None
        if not where or self.plain.get(where[0]) != "DSEG" or self._port(line.args[1]):
            return False
        for other in self.function.code[n + 1:]:
            if other.label or not other.op or other.op in ENDS | BRANCHES | CALLS or other in self.function.switches or \
                    any(cell(operand) == where for operand in other.args[other.op == "mov":]) or \
                    any(operand[0] == "@" for operand in other.args) and other.op != "movx":
                return False
            if other.op == "mov" and cell(other.args[0]) == where:
                return True
        return False

    def _port(self, operand):
        """Reading it may do something, or give something else each time."""
        if operand[0] in "#@" or register(operand):
            return False
        where = cell(operand)
        return operand != "ab" and operand != "nop" and not (where and where[0] in self.plain)

    # ---- a value that only passes through a register ----

    def _passed_on(self, n, live):
        """The line loads a register for one instruction only: let that one read from where the value comes."""
        line = self.function.code[n]
        if line.op not in ("mov", "clr") or line.writes not in BIT.values() or line.writes in (C, F) or "." in line.args[0]:
            return False
        source = line.args[1] if line.op == "mov" else "#0x00"
        if line.op == "clr" and line.args[0] != "a" or unknown(source) or "." in source or self._name(line)[0] not in "ar":
            return False
        for m in range(n + 1, min(n + 1 + AHEAD, len(self.function.code))):
            user = self.function.code[m]
            if user.label or not user.op or user.op in CALLS or user in self.function.away:
                return False
            if user.reads & line.writes:
                wanted = live[m + 1] | live[self.function.labels.get(user.goes_to, m + 1)]
                return self._direct(line, source, user, wanted, m == n + 1)
            if user.writes & (line.writes | self._read_by(source)) or user.op in ENDS | BRANCHES or self._changes(user, source):
                return False
        return False

    @staticmethod
    def _name(line):
        """of the register that a line sets: r7 of ar7, too"""
        return line.args[0].removeprefix("a") or "a"

    @staticmethod
    def _read_by(source):
        return register(source.lstrip("@"))

    def _changes(self, line, source):
        """May the line change what the source stands for?"""
        if source.startswith("#") or register(source):
            return False
        where = cell(source)
        if not where or where[0] not in self.plain:
            return True  # a port, or through a pointer
        first = line.args[0] if line.args else "a"
        return first.startswith("@") and line.op != "movx" or cell(first) in (where, None) and not register(first)

    def _direct(self, line, source, user, wanted, adjacent):
        name = self._name(line)
        if wanted & line.writes and not user.writes & line.writes or user.op == "pop":
            return False
        if self._port(source) and not adjacent:
            return False
        new = self._form(user, name, source)
        if new is None:
            return False
        self.function.put(user, *([new] if new.op else []))
        self.function.drop(line)
        return True

    @staticmethod
    def _form(user, name, source):
        """The user's instruction with the source in the place of the register, where there is one and it is no longer."""
        kind = "#" if source[0] == "#" else "@" if source[0] == "@" else "r" if source[0] == "r" and len(source) == 2 else \
            "a" if source == "a" else "direct"
        if len(user.args) < 2 or user.args[1] not in (name, "a" + name) or user.args[0] in (name, "a" + name):
            return None
        first, op = user.args[0], user.op
        if first in ("c", "psw", "_PSW") or "." in first:
            return None
        if op == "mov" and first[0] == "@":
            legal = kind in ("#", "direct")
        elif op == "mov":
            legal = {"a": kind != "a", "r": kind in "#a" or kind == "direct"}.get(
                "a" if first == "a" else "r" if first[0] == "r" else "", True)
        elif op in ("add", "addc", "subb", "anl", "orl", "xrl"):
            legal = first == "a" and name != "a" and kind != "a"
        elif op == "cjne":
            legal = first == "a" and kind in ("#", "direct")
        else:
            legal = False
        return instruction(op, first, source, *user.args[2:]) if legal else None

    # ---- push and pop ----

    def _saved_for_nothing(self, n, live):
        line, function = self.function.code[n], self.function
        if line.op != "push" or register(line.args[0]) not in BIT.values():
            return False
        depth, changed, bit = 0, 0, register(line.args[0])
        for m in range(n + 1, len(function.code)):
            other = function.code[m]
            if other.label or not other.op or other.op in ENDS | BRANCHES:
                return False
            if other.op == "pop" and depth == 0:
                if other.args != line.args or changed & bit and live[m + 1] & bit:
                    return False
                function.drop(other)
                function.drop(line)
                return True
            depth += {"push": 1, "pop": -1}.get(other.op, 0)
            changed |= self.flow.changed_by(function, other)
        return False
