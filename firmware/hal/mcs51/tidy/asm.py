"""SDCC's assembly as a program: files, functions, instructions, and what each instruction reads and writes.

Registers are bits of a number: A B C (carry) F (other flags) DPL DPH and R0 to R7 of the bank a function runs in.
Memory is written as cells: (symbol, offset).
"""
import re
from functools import lru_cache
from pathlib import Path

NAMES = ("a", "b", "c", "f", "dpl", "dph", "r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7")
BIT = {name: 1 << n for n, name in enumerate(NAMES)}
A, B, C, F, DPL, DPH = (BIT[n] for n in NAMES[:6])
DPTR = DPL | DPH
BANK = sum(BIT[f"r{n}"] for n in range(8))
ALL = (1 << len(NAMES)) - 1
RESULT = A | B | DPTR  # what a function's arguments and its result come in

LABEL = re.compile(r"^\s*([A-Za-z_.]\w*|\d+\$)(::?)\s*(.*)$")
SYMBOL = re.compile(r"^_\w+$")
NUMBER = r"(0x[0-9a-f]+|\d+)"
CELL = re.compile(rf"^(?:(_\w+)|\(\(?(_\w+) \+ {NUMBER}\)?(?: \+ {NUMBER}\))?)$")
LOCAL = re.compile(r"^(_\w+)_\d+_\d+$")  # _function_name_65536_12
DEFINITION = re.compile(r"(_\w+)\s*(?:::?|=)")
CODE_AREAS = ("CSEG", "HOME")
MEMORY = ("DSEG", "OSEG", "ISEG", "PSEG", "XSEG", "BSEG")
BRANCHES = {"jz", "jnz", "jc", "jnc", "jb", "jnb", "jbc", "cjne", "djnz"}
JUMPS = {"ljmp", "sjmp", "ajmp"}
CALLS = {"lcall", "acall"}
GO = BRANCHES | JUMPS | CALLS
RETURNS = {"ret", "reti"}
ENDS = JUMPS | RETURNS | {"jmp", ".db", ".byte", ".ascii"}
ALIASES = {"acc": "a", "_ACC": "a", "_B": "b", "_DPL": "dpl", "_DPH": "dph", "_CY": "c", "cy": "c", "_P": "a", "p": "a",
           **{f"ar{n}": f"r{n}" for n in range(8)}}
FLAGS = {"ov", "_OV", "ac", "_AC", "f0", "_F0", "_F1", "rs0", "rs1", "_RS0", "_RS1"}


@lru_cache(None)
def cell(operand):
    """(symbol, offset) of `_x`, `(_x + 3)` and `((_x + 3) + 1)`, None of anything else"""
    found = CELL.match(operand)
    return (found[1] or found[2], int(found[3] or "0", 0) + int(found[4] or "0", 0)) if found else None


def spelled(where):
    symbol, offset = where
    return f"({symbol} + 0x{offset:04x})" if offset else symbol


@lru_cache(None)
def register(operand):
    """BIT of an operand that is a register or a bit of one; 0: none"""
    name = operand.lstrip("/").split(".")[0]
    name = ALIASES.get(name, name) if name[:1] == "_" else ALIASES.get(name.lower(), name.lower())
    if name in ("psw", "_PSW"):
        return C | F | A
    if name in FLAGS:
        return F
    return DPTR if name == "dptr" else BIT.get(name, 0)


def unknown(operand):
    """An address in numbers: any register may be there."""
    return operand[:1].isdigit()


def used(operand):
    """What an operand reads when it is read, or what finding it reads."""
    if operand.startswith("@"):
        return sum(register(part) for part in operand[1:].split("+"))
    return ALL if unknown(operand) else register(operand)


class Line:
    """An instruction (op, args), a label (label), or anything else (text alone)."""

    __slots__ = ("text", "label", "op", "args", "where", "reads", "writes", "goes_to")

    def __init__(self, text):
        self.text, self.label, self.op, self.args = text, None, None, ()
        self.where = None  # the cell that a movx or a mov by @r0 reaches, if known
        code = text.split(";")[0]
        label = LABEL.match(code)
        if label and not label[3].startswith("="):
            self.label, code = label[1], label[3]
        words = code.split(None, 1)
        if words and (not words[0].startswith(".") or words[0] in ENDS) and "=" not in code:
            self.op = words[0].lower()
            self.args = tuple(" ".join(p.split()) for p in words[1].split(",")) if len(words) > 1 else ()
        self.reads, self.writes = self._effects() if self.op else (0, 0)
        self.goes_to = self.args[-1] if self.op in GO else None  # where it calls, jumps or branches

    def _effects(self):
        op, args = self.op, self.args
        first, second = (args + ("", ""))[:2]
        if op in ("mov", "movx", "movc"):
            part = first != "a" and "." in first  # of a register, a bit
            return used(second) | (used(first) if first.startswith("@") or part else 0), self._written(first)
        if op in ("add", "addc", "subb"):
            return A | used(second) | (C if op != "add" else 0), A | C | F
        if op in ("anl", "orl", "xrl", "xch", "xchd"):
            return used(first) | used(second), self._written(first) | (self._written(second) if op[0:3] == "xch" else 0)
        if op in ("inc", "dec", "cpl", "djnz", "jbc", "swap", "rl", "rr", "clr", "setb"):
            plain = op in ("clr", "setb") and "." not in first
            return 0 if plain else used(first), self._written(first)
        if op in ("rlc", "rrc"):
            return A | C, A | C
        if op == "da":
            return A | C | F, A | C
        if op in ("mul", "div"):
            return A | B, A | B | C | F
        if op in ("jz", "jnz", "jc", "jnc", "jb", "jnb"):
            return {"z": A, "c": C, "b": used(first)}[op[-1]], 0
        if op == "cjne":
            return used(first) | used(second), C
        if op in ("push", "pop"):
            return (used(first), 0) if op == "push" else (0, self._written(first))
        if op in JUMPS | CALLS | RETURNS | {"nop", ".db", ".byte", ".ascii"}:
            return 0, 0
        return (A | DPTR, 0) if op == "jmp" else (ALL, ALL)

    @staticmethod
    def _written(operand):
        return 0 if operand.startswith("@") else ALL if unknown(operand) else register(operand) & ~(
            A if operand in ("psw", "_PSW") else 0)

    def same(self, op, *args):
        return self.op == op and self.args == args

    def selects_bank(self):
        """Of an instruction that may select a register bank: the bank's number, -1: not known. None: it does not."""
        if not self.args or self.args[0].split(".")[0] not in ("psw", "_PSW", "rs0", "rs1", "_RS0", "_RS1") or \
                self.op not in ("mov", "pop", "anl", "orl", "xrl", "setb", "clr", "cpl"):
            return None
        number = re.match(r"#(0x[0-9a-f]+)$", self.args[-1])
        return int(number[1], 16) >> 3 & 3 if self.op == "mov" and number else -1


def instruction(op, *args):
    return Line(f"\t{op}\t{','.join(args)}".rstrip())


class Function:
    def __init__(self, name, path, lines, bank):
        self.name, self.path, self.lines, self.bank = name, path, lines, bank
        self.naked = any("naked function" in line.text or "__endasm" in line.text for line in lines)  # written by hand
        self.refresh()

    def refresh(self):
        """After a change of `lines`: code, its labels, and which label stands where."""
        self.code = [line for line in self.lines if line.op or line.label]
        self.labels = {line.label: n for n, line in enumerate(self.code) if line.label and line.label.endswith("$")}
        self.interrupt = any(line.op == "reti" for line in self.code)
        self.switches = [line for line in self.code if line.op and line.selects_bank() is not None]
        if self.naked and self.switches and self.switches[0].op == "mov":
            self.bank = self.switches[0].selects_bank()
        self._find_away()

    def _find_away(self):
        """away: the lines in another bank's registers, from the selection to that of the own one."""
        self.away, away = set(), False
        for line in self.code:
            if line in self.switches:
                away = line.op == "mov" and line.selects_bank() != self.bank
                self.away.add(line) if away else None
            elif away:
                self.away.add(line)

    def may_change(self):
        """Written by hand, with a table of jumps, a label's address or a frame on the stack: left as it is. Two underscores
        are the compiler's own: vectors and start-up."""
        return not self.naked and not self.name.startswith("__") and not any(line.label for line in self.away) and not any(
            line.op in ("jmp", ".db", ".byte", ".ascii") or line.op in CALLS and line.args[0].endswith("$") or
            any(re.search(r"(?i)\b_?(bp|sp)\b|#\d+\$", operand) for operand in line.args) for line in self.code)

    def drop(self, line):
        self.lines.remove(line)

    def put(self, old, *new):
        at = self.lines.index(old)
        self.lines[at:at + 1] = new


class Program:
    """All files of an image. parts: {path: [Function or list of lines]}"""

    def __init__(self, paths, volatile):
        self._globals = {}
        self.parts = {path: self._split(path, Path(path).read_text()) for path in paths}
        self.functions = [p for parts in self.parts.values() for p in parts if isinstance(p, Function)]
        self._own = {(f.path, f.name): f for f in self.functions}
        self._exported = {}
        for f in self.functions:
            if f.name in self._globals[f.path]:
                self._exported.setdefault(f.name, f)
        self._find_data(volatile)
        self._find_names()
        self._definitions = None

    def _split(self, path, text):
        parts, current, area, bank, name = [], [], "", 0, None
        self._globals[path] = set(re.findall(r"^\s*\.globl\s+(_\w+)", text, re.M))

        def close():
            parts.append(Function(name, path, current, bank) if name else current)

        for raw in text.splitlines():
            line = Line(raw)
            if line.text.split()[:1] == [".area"]:
                close()
                current, name, area = [], None, line.text.split()[1]
            elif line.label and SYMBOL.match(line.label) and area in CODE_AREAS:
                close()
                current, name = [], line.label
            found = re.match(r"\s+ar0 = 0x(\w+)", raw)
            if found:
                bank = int(found[1], 16) >> 3
            current.append(line)
        close()
        return parts

    def resolve(self, function, name):
        """The function that `name` means where it stands; None: a routine of the compiler's library"""
        return self._own.get((function.path, name)) or self._exported.get(name)

    def named_in(self, name):
        """The functions that name a symbol; None among them: a table, or start-up code."""
        return self._named.get(name, set())

    def _find_names(self):
        self._named = {}
        for part in (part for parts in self.parts.values() for part in parts):
            function = part if isinstance(part, Function) else None
            for line in function.lines if function else part:
                code = "" if line.label or line.text.split()[:1] == [".globl"] else line.text.split(";")[0]
                for name in re.findall(r"_\w+", code):
                    self._named.setdefault(name, set()).add(function)

    # ---- a function that moves into another ----

    def _defined(self, name):
        """The files where a symbol is a label, or a number."""
        if self._definitions is None:
            self._definitions = {}
            for path, parts in self.parts.items():
                for line in (line for part in parts for line in (part if isinstance(part, list) else part.lines)):
                    found = DEFINITION.match(line.text)
                    if found:
                        self._definitions.setdefault(found[1], set()).add(path)
        return self._definitions.get(name, set())

    def is_one(self, function):
        """Nobody else has its name, and nothing runs on into it."""
        parts = self.parts[function.path]
        before = [part for part in parts[:parts.index(function)] if isinstance(part, Function)][-1:]
        return (function.name not in self._globals[function.path] or len(self._defined(function.name)) == 1) and \
            all(f.code and f.code[-1].op in ENDS for f in before)

    def show(self, function, path):
        """-> can the function stand in another file? What it names there is what it names here, from now on."""
        here = function.path
        if path == here:
            return True
        names = {name for line in function.code for operand in line.args for name in re.findall(r"_\w+", operand)}
        own = {name for name in names if here in self._defined(name) and name not in self._globals[here]}
        if any(len(self._defined(name)) > 1 for name in own) or \
                any(path in self._defined(name) and name not in self._globals[path] for name in names):
            return False
        self.export(here, own)
        for name in own:
            if (here, name) in self._own:
                self._exported[name] = self._own[here, name]
            if name in self.plain[here]:
                self.plain[path][name] = self.plain[here][name]
        for name in names - self.plain[here].keys():
            self.plain[path].pop(name, None)
        return True

    def export(self, path, names):
        for name in sorted(set(names) - self._globals[path]):
            self._globals[path].add(name)
            self.parts[path][0].insert(0, Line(f"\t.globl {name}"))

    def copied(self, function, into):
        """It stands in another one, too, which calls it no more."""
        for others in self._named.values():
            if function in others:
                others.add(into)
        self._named[function.name].discard(into)

    def moved(self, function, into):
        """It stands in another one and is a function no more. -> What says where, if it can be seen from outside: a symbol."""
        path, name, parts = function.path, function.name, self.parts[function.path]
        # the numbers of registers stay where they are for what follows
        parts[parts.index(function)] = [line for line in function.lines if re.match(r"\s+ar\d = ", line.text)]
        self.functions.remove(function)
        del self._own[path, name], self._named[name]
        for others in self._named.values():
            if function in others:
                others.remove(function)
                others.add(into)
        if name not in self._globals[path]:
            return Line(f"; {name}")
        del self._exported[name]
        return Line(f"{name} = .")

    def _find_data(self, volatile):
        """plain: {path: {name: area}}, variables that nobody but compiled C changes behind the compiler's back, as a file
        knows them; taken: functions' addresses"""
        by_hand = {name for f in self.functions if f.naked for line in f.code for operand in line.args
                   for name in re.findall(r"_\w+", operand)}
        own, everywhere = {}, {}
        for path, parts in self.parts.items():
            own[path], area = {}, ""
            for line in (line for part in parts for line in (part if isinstance(part, list) else ())):
                if line.text.split()[:1] == [".area"]:
                    area = line.text.split()[1]
                elif line.label:
                    left = line.label in by_hand or self._may_be(line.label, volatile[path]) or \
                        "/hal/mcs51/" in path and not LOCAL.match(line.label)
                    own[path][line.label] = area if area in MEMORY and not left else None
            everywhere.update((name, kind) for name, kind in own[path].items() if name in self._globals[path])
        self.plain = {path: {name: kind for name, kind in {**everywhere, **own[path]}.items() if kind} for path in own}
        self.taken = set()
        names = {f.name for f in self.functions}
        for parts in self.parts.values():
            for part in parts:
                for line in part if isinstance(part, list) else part.lines:
                    code = line.text.split(";")[0]
                    if ".byte" in code or ".db" in code or ".word" in code or ".dw" in code or "#" in code:
                        self.taken |= names.intersection(re.findall(r"_\w+", code))

    @staticmethod
    def _may_be(label, names):
        """Is it one of these names in C, or a local of that name?"""
        local = LOCAL.match(label)
        return label[1:] in names or local and any(local[1][n + 1:] in names for n, c in enumerate(local[1]) if c == "_")

    def write(self):
        for path, parts in self.parts.items():
            lines = [line.text for part in parts for line in (part if isinstance(part, list) else part.lines)]
            Path(path).write_text("".join(text + "\n" for text in lines))
