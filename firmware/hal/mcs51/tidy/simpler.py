"""Rules of one instruction or two, with what is known before them (known.py).

  what is to be fetched is there already            nothing
  it is in a register that is cheaper to read       from there
  DPTR points there already, or one octet before    nothing, or inc dptr
  a store of what the place holds                   nothing
  mov a,X / add a,Y with Y in A before              add a,X
  *p++ twice                                        DPTR counts, p is set behind it
  DPTR to be set to what it is, or one more, by a   nothing, or inc dptr
  sum of 16 bits
  mov a,X / dec a / mov X,a                         dec X / mov a,X
  mov R,X / anl R,#k / mov a,R                      the same in A, which is shorter
  mov R,a with one more, or less, than R has        inc R, dec R
  a copy in another register                        the one that has had it for longer: the copy may be unread then
  a branch on what is known                         a jump, or nothing

None makes anything longer, nor slower.
"""
from asm import A, BRANCHES, C, CALLS, DPTR, ENDS, F, cell, instruction, register, spelled, unknown
from known import Follower, constant, plus, pointer

COMMUTATIVE = ("add", "anl", "orl", "xrl")
NEXT_USE = 8
STOPS = ENDS | BRANCHES | CALLS
REGISTERS = [f"r{n}" for n in range(8)]


class Simplifier:
    def __init__(self, program, flow, function, own):
        self.flow, self.function, self.gone, self.changed = flow, function, set(), False
        self.follower = Follower(program, flow, function, own)

    def run(self):
        live = self.flow.live(self.function, self.flow.wanted[self.function])
        self.live = dict(zip(self.function.code, live))
        self.follower.walk(self.improve)
        if self.changed:
            self.function.refresh()
        return self.changed

    @property
    def now(self):
        return self.follower.now

    def improve(self, line):
        if line in self.gone:
            return []
        new = self._better(line)
        if new is None:
            other = self._older(line)
            if other is None:
                return [line]
            new = [other]
        self.changed = True
        self.function.put(line, *new)
        return new

    def _next(self, line, number=1):
        """The following instructions, as far as no label comes between."""
        lines, at = self.function.lines, self.function.lines.index(line)
        found = []
        for other in lines[at + 1:]:
            if other.label or len(found) == number:
                break
            if other.op:
                found.append(other)
        return found + [instruction("nop")] * (number - len(found))

    def _drop_next(self, lines):
        for line in lines:
            self.gone.add(line)
            self.function.drop(line)

    def _better(self, line):
        op, args = line.op, line.args
        first, second = (args + ("", ""))[:2]
        if op == "mov" and first == "dptr":
            return self._pointer_constant(line, second)
        if op == "mov" and first == "dpl" and self._next(line)[0].args[:1] == ("dph",) and self._next(line)[0].op == "mov":
            better = self._pointer_pair(line)
            return self._move(line, first, second) if better is None else better
        if op == "mov" and first == "dpl" and second == "a":
            better = self._pointer_sum(line)
            return self._move(line, first, second) if better is None else better
        if op == "mov":
            return self._counted(line, first, second) or self._joined(line) or self._through_a(line, first, second) or self._move(line, first, second)
        if op in ("anl", "orl", "xrl") and second == "a" and self._next(line)[0].same("mov", "a", first[1:]) \
                and self._is_r(first[1:]):
            self._drop_next(self._next(line))
            return [instruction(op, "a", first[1:]), instruction("mov", first[1:], "a")]
        if op == "inc" and cell(first):
            return self._counted_pointer(line, first)
        if op == "movx":
            return self._external(line, first, second)
        if op in ("clr", "setb") and first in ("a", "c"):
            return [] if self.now.of(first) == ("#", int(op == "setb")) else None
        if op in BRANCHES and self.follower.outcome(line) is not None and not (op == "cjne" and self._wants_carry(line)):
            return [instruction("ljmp", line.goes_to)] if self.follower.outcome(line) else []
        if op == "rlc" and self.now.of("a")[0] == self.now.of("c")[0] == "#" and not self._wanted_behind(line) & C:
            return [instruction("mov", "a", f"#0x{self.follower.ahead([line]).of('a')[1]:02x}")]
        if op in COMMUTATIVE + ("addc", "subb") and first == "a" and not register(second) and second[0] != "@":
            where = self._where(self.follower.value(second))
            return [instruction(op, "a", where)] if where else None
        return None

    def _wants_carry(self, line):
        there = self.function.code[self.function.labels[line.goes_to]] if line.goes_to in self.function.labels else None
        return (self._wanted_behind(line) | self.live.get(there, ~0)) & C

    def _wanted_behind(self, line):
        code = self.function.code
        return self.live.get(code[code.index(line) + 1], ~0) if line in self.live and line is not code[-1] else ~0

    def _where(self, value):
        """A register of the bank that holds a value."""
        return next((r for r in REGISTERS if value and self.now.held.get(r) == value), None)

    def _older(self, line):
        """The instruction with the register in the place of another that has had the same value for longer."""
        if line.op in ("push", "pop", "djnz", "xch", "xchd", "inc", "dec", "jmp") or line.args[-1:] == ("c",):
            return None
        args = list(line.args)
        for place, operand in enumerate(args):
            name = operand.lstrip("@").removeprefix("a") if operand != "a" else ""
            reads = place > 0 or operand[0] == "@" or line.op == "cjne"
            if name not in REGISTERS or not reads:
                continue
            value = self.now.held.get(name)
            if line.op == "cjne" and place == 0 and value and self.now.held.get("a") == value:
                args[place] = "a"
                continue
            choice = REGISTERS[:2] if operand[0] == "@" else REGISTERS
            older = next((r for r in self.now.held if value and r in choice and self.now.held[r] == value), name)
            args[place] = operand.replace(name, older)
        return instruction(line.op, *args) if tuple(args) != line.args else None

    # ---- DPTR ----

    def _at(self):
        return pointer(self.now.of("dpl"), self.now.of("dph"))

    def _pointer_constant(self, line, second):
        found = constant(second)
        if not found or found[0] not in ("#", "low"):
            return None
        base, offset = found[1:] if found[0] == "low" else ("", found[1])
        at, there = self._at()
        if at == base and there == offset:
            return []
        return [instruction("inc", "dptr")] if at == base and there + 1 == offset else None

    def _pointer_pair(self, line):
        high = self._next(line)[0]
        low_value, high_value = self.follower.value(line.args[1]), self.follower.value(high.args[1])
        if not low_value or not high_value or high.args[1] == "dpl":
            return None
        base, offset = pointer(low_value, high_value)
        steps = [step for step in self._next(high, 9)]
        steps = steps[:next((n for n, s in enumerate(steps) if not s.same("inc", "dptr")), len(steps))]
        at, there = self._at()
        if at != base or not offset - 1 <= there <= offset + len(steps):
            return None
        self._drop_next([high] + steps[:max(there - offset, 0)])
        return [instruction("inc", "dptr")] * (there < offset)

    def _pointer_sum(self, line):
        """mov dpl,a / clr a / addc a,X / mov dph,a: the low half of a sum, and the high one with its carry."""
        low, following = self.now.of("a"), self._next(line, 4)
        high = following[2]
        if following[0].args[:1] != ("a",) or following[1].op != "addc" or not high.same("mov", "dph", "a") or \
                following[0].op not in ("clr", "mov") or \
                self.live.get(following[3], ~0) & (A | C | F):
            return None
        base, offset = pointer(low, self.follower.ahead(following[:2]).of("a"))
        at, there = self._at()
        if at != base or there not in (offset, offset - 1):
            return None
        self._drop_next(following[:3])
        return [instruction("inc", "dptr")] * (there < offset)

    def _counted(self, line, first, second):
        """mov a,X / dec a / mov X,a, X being a register or a variable."""
        middle, last = self._next(line, 2)
        if first != "a" or not (self._is_r(second) or self.follower.cell_of(second)) or not last.same("mov", second, "a") or \
                middle.op not in ("inc", "dec") or middle.args != ("a",):
            return None
        self._drop_next([middle, last])
        return [instruction(middle.op, second), instruction("mov", "a", second)]

    def _counted_pointer(self, line, low):
        """inc _p / clr a / cjne a,_p,L / inc (_p + 1) / L: where DPTR is _p, and will be again: inc dptr, and stored."""
        where = cell(low)
        at = self.function.lines.index(line)
        rest = [other for other in self.function.lines[at + 1:] if other.op or other.label][:4 + NEXT_USE]
        high = spelled((where[0], where[1] + 1))
        if len(rest) < 5 or not rest[0].same("clr", "a") or rest[1].op != "cjne" or rest[1].args[:2] != ("a", low) or \
                rest[2].op != "inc" or cell(rest[2].args[0]) != cell(high) or rest[3].label != rest[1].goes_to or rest[3].op or \
                self.follower.cell_of(low) is None or self.live[rest[3]] & (A | C | F | DPTR) or \
                sum(rest[3].label in other.args for other in self.function.code) != 1:
            return None
        ahead = rest[4:]
        ahead = ahead[:next((n for n, other in enumerate(ahead) if not other.op or other.op in STOPS), len(ahead))]
        uses = [other for other in ahead if other.op == "mov" and other.args[0] in ("dpl", "dptr")]
        if not uses or not uses[0].same("mov", "dpl", low) or self._at() != pointer(self.now.of(where), self.now.of(cell(high))):
            return None
        self._drop_next(rest[:3])
        return [instruction("inc", "dptr"), instruction("mov", low, "dpl"), instruction("mov", high, "dph")]

    # ---- moves ----

    def _move(self, line, first, second):
        value = self.follower.value(second)
        if value is None or unknown(first) or "." in first or first in ("c", "psw", "_PSW") or second == "c":
            return None
        name, where = self.follower._register(first), self.follower.cell_of(first)
        if not name and not where and (first[0] == "@" or second[0] == "#"):
            return None  # what a port is set to is looked for by the checks
        if self.now.held.get(name or where) == value:
            return []
        if self._is_r(first) and (second == "a" or second[0] == "#") and self.now.held.get(first):  # A may be unread then
            for op, step in (("inc", 1), ("dec", -1)):
                if plus(self.now.held[first], step) == value:
                    return [instruction(op, first)]
        return self._cheaper(first, second, value)

    def _cheaper(self, first, second, value):
        if first == "a":
            if value == ("#", 0):
                return [instruction("clr", "a")]
            where = None if self._is_r(second) else self._where(value)
        elif self._is_r(first):
            where = "a" if second != "a" and self.now.held.get("a") == value else None
        else:  # a direct place
            where = "a" if second != "a" and self.now.held.get("a") == value else \
                None if self._is_r(second) or second == "a" or first[0] == "@" else self._where(value)
        return [instruction("mov", first, where)] if where else None

    @staticmethod
    def _is_r(operand):
        return operand in REGISTERS

    def _joined(self, line):
        """mov a,X / add a,Y where A holds Y's value: add a,X."""
        following = self._next(line)[0]
        if line.args[0] != "a" or following.op not in COMMUTATIVE or following.args[0] != "a" or \
                following.args[1] in ("a", "acc") or line.args[1].startswith("@") and following.args[1].startswith("@"):
            return None
        value = self.follower.value(following.args[1])
        if value is None or value != self.now.of("a") or line.args[1] in ("acc", "c"):
            return None
        self._drop_next([following])
        return [instruction(following.op, "a", line.args[1])]

    def _through_a(self, line, first, second):
        """mov R,X / anl R,#k / mov a,R: mov a,X / anl a,#k / mov R,a."""
        middle, last = self._next(line, 2)
        if not self._is_r(first) or middle.op not in ("anl", "orl", "xrl") or middle.args[0] != "a" + first or \
                middle.args[1][0] != "#" or not last.same("mov", "a", first):
            return None
        self._drop_next([middle, last])
        return [instruction("mov", "a", second)] * (second != "a") + [
            instruction(middle.op, "a", middle.args[1]), instruction("mov", first, "a")]

    # ---- external RAM ----

    def _external(self, line, first, second):
        where = self.follower.external(first if first != "a" else second)
        if not where:
            return None
        value = self.now.held.get(where)
        if first != "a":
            return [] if value is not None and value == self.now.of("a") else None
        if value is None:
            return None
        if value == self.now.of("a"):
            return []
        register_ = self._where(value)
        return [instruction("mov", "a", register_)] if register_ else [instruction("clr", "a")] if value == ("#", 0) else None
