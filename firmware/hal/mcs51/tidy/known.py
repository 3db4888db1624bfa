"""What registers and memory hold, forward through a function: what is there already is not fetched again.

A value is anything equal to itself: a constant, what an operation makes of two values, or one of its own kind that
nobody else has. Behind a label only what every way to it agrees on is known; a loop's head knows nothing.
DPTR: what belongs together are the halves ("low", symbol, offset) and ("high", symbol, offset), and of a pair of values the
sum of its low one and ("upper", low, high, offset); so one access behind another is known to be an `inc dptr` away, and a
sum of 16 bits for a pointer. What carry holds behind an addition is ("carry", value, number).

Memory is followed only in variables that compiled C alone changes (Program.plain); a call, a store through a pointer,
or an access to a port ends what is known of all but the function's own locals.
"""
import re
from functools import lru_cache
from itertools import count

from asm import BANK, BIT, BRANCHES, C, CALLS, DPTR, ENDS, JUMPS, NAMES, RETURNS, cell, register, unknown

CONSTANT = re.compile(r"^#(0x[0-9a-f]+|\d+)$")
ADDRESS = re.compile(r"^#\(?(_\w+)(?: \+ (0x[0-9a-f]+|\d+)\)?)?$")
HIGH = re.compile(r"^#\(\(?(_\w+)(?: \+ (0x[0-9a-f]+|\d+)\))? >> 8\)$")
ACC_BIT = re.compile(r"acc\.(\d)$")
PURE = {"anl", "orl", "xrl", "add"}  # of A and another operand, either way round
numbers = count()
results = {}  # of operations: what is made of the same in the same way has the same number


def fresh():
    return "own", next(numbers)


def result(*of):
    return "made", results.setdefault(of, len(results))


@lru_cache(None)
def constant(operand):
    found = CONSTANT.match(operand)
    if found:
        return "#", int(found[1], 0)
    for pattern, half in ((ADDRESS, "low"), (HIGH, "high")):
        found = pattern.match(operand)
        if found:
            return half, found[1], int(found[2] or "0", 0)
    return ("text", operand) if operand.startswith("#") else None


def plus(value, number):
    """value + number, in eight bits"""
    number = (number + 128) % 256 - 128
    if value[0] == "#":
        return "#", value[1] + number & 0xFF
    if value[0] == "low":
        return "low", value[1], value[2] + number
    base, before = value[1:] if value[0] == "sum" else (value, 0)
    return ("sum", base, before + number & 0xFF) if (before + number) & 0xFF else base


def combined(op, one, other):
    """What `add`, `anl`, `orl` or `xrl` makes of two values in order."""
    if op == "add" and one[0] == "#":
        return plus(other, one[1])
    if one[0] == other[0] == "#":
        return "#", {"anl": one[1] & other[1], "orl": one[1] | other[1], "xrl": one[1] ^ other[1]}[op]
    return result(op, one, other)


def pointer(low, high):
    """(base, offset) of a DPTR with these halves"""
    if low[0] == "low" and high[0] == "high" and low[1:] == high[1:]:
        return low[1:]
    if low[0] == "#" and high[0] == "#":
        return "", low[1] | high[1] << 8
    if high[0] == "upper" and low == plus(high[1], high[3]):
        return ("pair", *high[1:3]), high[3]
    return ("pair", low, high), 0


def halves(base, offset):
    if base == "":
        return ("#", offset & 0xFF), ("#", offset >> 8 & 0xFF)
    if base[0] == "pair":
        return plus(base[1], offset), ("upper", *base[1:], offset) if offset else base[2]
    return ("low", base, offset), ("high", base, offset)


def upper(low, high, number):
    """High half of what is `number` more than a pair of values."""
    base, offset = pointer(low, high)
    return halves(base, (offset + number + 0x8000 & 0xFFFF) - 0x8000)[1]


class Known:
    """Where -> value. Where is the name of a register or a cell."""

    def __init__(self, held=None):
        self.held = dict(held or {})

    def of(self, where):
        if where not in self.held:
            self.held[where] = fresh()
        return self.held[where]

    def put(self, where, value):
        """The first in `held` has had its value for the longest time."""
        self.held.pop(where, None)
        self.held[where] = value

    def forget(self, registers):
        for name in NAMES:
            if registers & BIT[name]:
                self.held.pop(name, None)

    def forget_memory(self, kept):
        for where in [w for w in self.held if isinstance(w, tuple) and w[0] not in kept]:
            del self.held[where]

    def replace(self, old, new):
        """Two values turn out to be the same."""
        for where, value in self.held.items():
            if value == old:
                self.held[where] = new

    def agree(self, other):
        return Known({w: v for w, v in self.held.items() if other.held.get(w) == v})


class Follower:
    """Walks one function; `improve` sees each instruction when `now` is what is known before it, and says what is there instead."""

    def __init__(self, program, flow, function, own):
        self.plain, self.flow, self.function, self.own = program.plain[function.path], flow, function, own
        self.now, self.at_labels, self.loops = Known(), {}, self._loop_heads()

    def _loop_heads(self):
        code, labels = self.function.code, self.function.labels
        return {line.goes_to for n, line in enumerate(code)
                if line.op in JUMPS | BRANCHES and labels.get(line.goes_to, n + 1) <= n}

    def walk(self, improve):
        reached = True
        for line in list(self.function.code):
            if line.label:
                before = self.at_labels.get(line.label)
                if line.label in self.loops or not line.label.endswith("$"):
                    self.now = Known()
                elif reached:
                    self.now = self.now.agree(before) if before else self.now
                else:
                    self.now = before or Known()
                reached = True
            if not line.op:
                continue
            if not reached:
                continue
            for done in [line] if line in self.function.away else improve(line):
                self.step(done)
                reached = done.op not in ENDS

    def ahead(self, lines):
        """What will be known behind these lines."""
        now, self.now = self.now, Known(self.now.held)
        for line in lines:
            self.step(line)
        now, self.now = self.now, now
        return now

    def value(self, operand):
        """of what an operand reads; None: nobody knows, and it may be different the next time"""
        found = constant(operand)
        if found:
            return found
        name = operand
        if name in ("acc", "a", "b", "c", "dpl", "dph") or re.match(r"a?r\d$", name):
            return self.now.of({"acc": "a"}.get(name, name.lstrip("a") if name.startswith("ar") else name))
        where = self.cell_of(operand)
        return self.now.of(where) if where else None

    def cell_of(self, operand):
        """The cell of a direct operand or of one that a register points to, if it is one that can be followed."""
        kinds = ("DSEG", "OSEG")
        where = cell(operand)
        if operand in ("@r0", "@r1"):
            at, kinds = self.now.of(operand[1:]), ("ISEG", "DSEG", "OSEG")
            where = at[1:] if at[0] == "low" and isinstance(at[1], str) else None
        return where if where and self.plain.get(where[0]) in kinds else None

    def bit_of(self, operand):
        """The cell of a bit that is the function's own."""
        where = cell(operand)
        return where if where and where[0] in self.own and self.plain.get(where[0]) == "BSEG" else None

    def outcome(self, line):
        """Is this branch taken? None: not known"""
        op, now = line.op, self.now
        if op in ("jz", "jnz", "jc", "jnc"):
            value = now.of("a" if op[-1] == "z" else "c")
            return ((value[1] == 0) == (op in ("jz", "jnc"))) if value[0] == "#" else None
        if op in ("jb", "jnb"):
            number = ACC_BIT.match(line.args[0])
            value = now.of("a") if number else now.of(self.bit_of(line.args[0])) if self.bit_of(line.args[0]) else fresh()
            return bool(value[1] >> int(number[1] if number else 0) & 1) == (op == "jb") if value[0] == "#" else None
        if op == "cjne":
            one, other = self.value(line.args[0]), self.value(line.args[1])
            return one != other if one and other and one[0] == other[0] == "#" else None
        return None

    def external(self, operand):
        if operand == "@dptr":
            where, kinds = pointer(self.now.of("dpl"), self.now.of("dph")), ("XSEG", "PSEG")
        else:
            at, kinds = self.now.of(operand[1:]), ("PSEG",)
            where = at[1:] if at[0] == "low" else (None, 0)
        return where if isinstance(where[0], str) and self.plain.get(where[0]) in kinds else None

    def step(self, line):
        """What is known behind an instruction."""
        now, op, args = self.now, line.op, line.args
        first, second = (args + ("", ""))[:2]
        if first == "dptr" and op in ("mov", "inc"):
            self._point(op, second)
        elif op in ("mov", "movx"):
            self._move(line, first, second)
        elif op in PURE and first == "a" and self.value(second):
            one, other = sorted((now.of("a"), self.value(second)), key=repr)
            now.forget(line.writes)
            now.put("a", combined(op, one, other))
            if op == "add" and one[0] == "#":
                now.put("c", ("#", other[1] + one[1] >> 8) if other[0] == "#" else ("carry", other, one[1]) if one[1] else ("#", 0))
        elif op == "addc" and now.of("c")[0] == "carry" and self.value(second):
            one, other = sorted((now.of("a"), self.value(second)), key=repr)
            low, number = now.of("c")[1:]
            now.forget(line.writes)
            if one[0] == "#":
                now.put("a", upper(low, other, one[1] << 8 | number))
        elif op in ("inc", "dec") and (self._register(first) or self.cell_of(first)):
            name = self._register(first) or self.cell_of(first)
            now.put(name, plus(now.of(name), 1 if op == "inc" else -1))
        elif op in ("cpl", "swap", "rl", "rr") and self._register(first):
            now.put(first, result(op, now.of(first)))
        elif op in ("clr", "setb") and (first in ("a", "c") or self.bit_of(first)):
            now.put(first if first in ("a", "c") else self.bit_of(first), ("#", int(op == "setb")))
        elif op == "cpl" and first == "c" and now.of("c")[0] == "#":
            now.put("c", ("#", 1 - now.of("c")[1]))
        elif op == "rlc" and now.of("a")[0] == now.of("c")[0] == "#":
            total = now.of("a")[1] << 1 | now.of("c")[1]
            now.put("a", ("#", total & 0xFF))
            now.put("c", ("#", total >> 8))
        else:
            self._other(line, first)

    def _point(self, op, second):
        now, found = self.now, constant(second)
        if op == "inc":
            base, offset = pointer(now.of("dpl"), now.of("dph"))
            now.held["dpl"], now.held["dph"] = halves(base, offset + 1)
        elif found and found[0] == "#":
            now.held["dpl"], now.held["dph"] = halves("", found[1])
        elif found and found[0] == "low":
            now.held["dpl"], now.held["dph"] = halves(*found[1:])
        else:
            now.forget(DPTR)

    @staticmethod
    def _register(operand):
        bit = register(operand)
        return NAMES[bit.bit_length() - 1] if bit and not bit & (bit - 1) and "." not in operand and operand != "c" else None

    def _move(self, line, first, second):
        now = self.now
        if line.op == "movx":
            line.where = self.external(first if first != "a" else second)
            if first == "a":
                now.put("a", now.of(line.where) if line.where else fresh())
            else:
                if not line.where:  # external RAM alone
                    now.forget_memory(self.own | {n for n, kind in self.plain.items() if kind not in ("XSEG", "PSEG")})
                else:
                    now.put(line.where, now.of("a"))
            return
        if "c" in (first, second) and (self.bit_of(first) or self.bit_of(second)):
            now.put("c" if first == "c" else self.bit_of(first), now.of(self.bit_of(second) or "c"))
            return
        value = self.value(second) or fresh()
        name, where = self._register(first), self.cell_of(first)
        line.where = where if first.startswith("@") else self.cell_of(second) if second.startswith("@") else None
        if name and line.writes == BIT[name]:
            now.put(name, value)
        elif where:
            now.put(where, value)
        else:
            self._other(line, first)

    def _other(self, line, first):
        now, op = self.now, line.op
        if op in BRANCHES:
            self._branch(line)
            return
        if op in JUMPS:
            self._remember(line.goes_to, now)
            return
        if op in CALLS:
            now.forget(self.flow.changed_by(self.function, line))
            now.forget_memory(self.own)
            return
        if op in RETURNS:
            return
        if op in ("xch", "xchd") or unknown(first):
            now.held = {}
        if line in self.function.switches:
            now.forget(BANK)
        now.forget(line.writes)
        if op == "push" or line.writes and not first.startswith(("@", "_", "(")):
            return
        where = self.cell_of(first)
        if where:
            now.held[where] = fresh()
        elif self.plain.get(first) != "BSEG":  # a port, or anywhere
            now.forget_memory(self.own)

    def _branch(self, line):
        now, op, args = self.now, line.op, line.args
        there = Known(now.held)
        if op == "jbc" or op == "djnz":
            there.forget(line.writes)
            where = self.cell_of(args[0])
            if where:
                there.held[where] = fresh()
            elif not line.writes:
                there.forget_memory(self.own)
            now.held = dict(there.held)
        if op == "cjne":
            there.forget(C)
            now.held = dict(there.held)
            one, other = self.value(args[0]), self.value(args[1])
            if one and other and one[0] == other[0] == "#":
                there.held["c"] = ("#", int(one[1] < other[1]))
            elif one and other:
                now.replace(one, other) if other[0] == "#" else now.replace(other, one)
            now.held["c"] = ("#", 0)
        if op in ("jz", "jnz"):
            (there if op == "jz" else now).replace(now.of("a"), ("#", 0))
        if op in ("jc", "jnc"):
            there.held["c"], now.held["c"] = (("#", 1), ("#", 0)) if op == "jc" else (("#", 0), ("#", 1))
        if op in ("jb", "jnb") and self.bit_of(args[0]):
            where = self.bit_of(args[0])
            there.held[where], now.held[where] = (("#", 1), ("#", 0)) if op == "jb" else (("#", 0), ("#", 1))
        self._remember(line.goes_to, there)

    def _remember(self, label, known):
        before = self.at_labels.get(label)
        self.at_labels[label] = known.agree(before) if before else Known(known.held)
