#!/usr/bin/env python3
"""Random programs do the same before and after firmware/hal/mcs51/tidy: played on a model of the 8051's instructions.

Same are, each time the function looked at has returned: variables in all kinds of memory, the function's result, and every
access to a port or a volatile variable, in order. Its own locals and whatever no caller reads may differ.
usage: tidy_random.py [PROGRAMS [FIRST SEED]]
"""
import os
import random
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "firmware" / "hal" / "mcs51" / "tidy"))
from asm import Program, cell  # noqa: E402
from whole import tidy  # noqa: E402

DIRECT = {name: 0x30 + 2 * n for n, name in enumerate(("_g", "_h", "_p", "_n", "_v", "_f_sloc0_1_0", "_c_sloc0_1_0", "_e_sloc0_1_0", "_t_sloc0_1_0", "_k"))}
EXTERNAL = {name: 0x0104 + 0x7E * n for n, name in enumerate(
    ("_x", "_y", "_w", "_f_s_65536_1", "_f_t_65536_2", "_c_s_65536_1", "_e_s_65536_1", "_t_s_65536_1"))}
PAGED = {"_q": 0x20, "_u": 0x28}
INDIRECT = {"_i": 0x90, "_j": 0x98}
BITS = ("_bit", "_f_sloc1_1_0")
WATCHED = ("_v", "_w", "_PORT")  # volatile, or a port
ADDRESSES = {**DIRECT, **EXTERNAL, **PAGED, **INDIRECT, "_PORT": 0x180}
ELSEWHERE = ("_e_sloc0_1_0", "_k", "_e_s_65536_1", "_c_sloc0_1_0", "_c_s_65536_1")  # of the second file, known there alone


def head(here):
    """What a file begins with. here: is a variable its own?"""
    areas = (("DSEG", DIRECT), ("XSEG", EXTERNAL), ("PSEG", PAGED), ("ISEG", INDIRECT), ("BSEG", BITS))
    every = [name for _, names in areas for name in names]
    shown = [name for name in every if name != "_k" and "sloc" not in name and "65536" not in name]
    return "".join(f"\t.globl {name}\n" for name in shown + ["_f", "_c", "_d", "_e"]) + "_PORT\t=\t0x0090\n" + "".join(
        f"\t.area {area}\n" + "".join(f"{name}:\n" for name in names if here(name)) for area, names in areas) + "\t.area CSEG\n"


class Chip:
    def __init__(self, program, seed):
        self.functions = {f.name: f for f in program.functions}
        dice = random.Random(seed)
        self.direct = {at: dice.randrange(256) for at in range(0x200)}
        self.external = {at: at * 37 + 11 & 0xFF for at in range(0x10000)}
        self.bits, self.stack, self.trace, self.fuel = dict.fromkeys(BITS, 0), [], [], 20000

    def start(self, seed):
        """Registers hold anything."""
        dice = random.Random(seed)
        self.a, self.b, self.dpl, self.dph, *bank = (dice.randrange(256) for _ in range(12))
        self.c = dice.randrange(2)
        self.direct.update(enumerate(bank))

    def number(self, text):
        high = text.endswith(">> 8)")
        text = text[1:-5].strip() if high else text
        where = cell(text.strip())
        value = ADDRESSES[where[0]] + where[1] if where else int(text, 0)
        return value >> 8 if high else value

    def address(self, operand):
        where = cell(operand)
        if where[0] in WATCHED:
            self.trace.append((operand, len(self.trace)))
        return ADDRESSES[where[0]] + where[1]

    def outside(self, operand):
        at = self.dph << 8 | self.dpl if operand == "@dptr" else self.direct[int(operand[2])]
        if EXTERNAL["_w"] <= at < EXTERNAL["_w"] + 8:
            self.trace.append(("_w", at))
        return at

    def get(self, operand):
        if operand[0] == "#":
            return self.number(operand[1:]) & 0xFF
        if operand in ("a", "b", "dpl", "dph", "c"):
            return getattr(self, operand)
        if operand == "acc":
            return self.a
        if re.match(r"acc\.\d", operand):
            return self.a >> int(operand[4]) & 1
        if operand in self.bits:
            return self.bits[operand]
        if re.match(r"a?r\d", operand):
            return self.direct[int(operand[-1])]
        return self.direct[self.direct[int(operand[2])] if operand[0] == "@" else self.address(operand)]

    def put(self, operand, value):
        value &= 0xFF
        if operand in ("a", "b", "dpl", "dph", "c"):
            setattr(self, operand, value)
        elif operand == "acc":
            self.a = value
        elif operand in self.bits:
            self.bits[operand] = value
        elif re.match(r"a?r\d", operand):
            self.direct[int(operand[-1])] = value
        else:
            at = self.direct[int(operand[2])] if operand[0] == "@" else self.address(operand)
            self.direct[at] = value
            if any(operand.lstrip("(").startswith(name) for name in WATCHED):
                self.trace.append(value)

    def call(self, name):
        function, n, depth = self.functions[name], 0, len(self.stack)
        while True:
            line = function.code[n]
            n += 1
            self.fuel -= 1
            assert self.fuel, "it goes on and on"
            if not line.op:
                continue
            op, args = line.op, line.args
            if op == "ret":
                assert len(self.stack) == depth, "the stack"
                return
            if op in ("lcall", "acall"):
                self.call(args[0])
            elif op in ("ljmp", "ajmp", "sjmp") and args[0] in self.functions:
                assert len(self.stack) == depth, "the stack"
                return self.call(args[0])
            elif self.play(op, args):
                n = function.labels[args[-1]]

    def play(self, op, args):
        """-> does it branch?"""
        first, second = (args + ("", ""))[:2]
        if op in ("jb", "jnb"):
            return bool(self.get(first)) == (op == "jb")
        if op in ("sjmp", "ljmp", "jz", "jnz", "jc", "jnc"):
            return {"jz": not self.a, "jnz": self.a, "jc": self.c, "jnc": not self.c}.get(op, True)
        if op == "cjne":
            one, other = self.get(first), self.get(second)
            self.c = int(one < other)
            return one != other
        if op == "djnz":
            self.put(first, self.get(first) - 1)
            return self.get(first) != 0
        if op == "mov" and first == "dptr":
            self.dph, self.dpl = divmod(self.number(second[1:]), 256)
        elif op == "inc" and first == "dptr":
            self.dph, self.dpl = divmod((self.dph << 8 | self.dpl) + 1 & 0xFFFF, 256)
        elif op == "mov":
            self.put(first, self.get(second))
        elif op == "movx" and first == "a":
            self.a = self.external[self.outside(second)]
        elif op == "movx":
            self.external[self.outside(first)] = self.a
        elif op in ("add", "addc"):
            total = self.a + self.get(second) + (self.c if op == "addc" else 0)
            self.a, self.c = total & 0xFF, total >> 8
        elif op == "subb":
            total = self.a - self.get(second) - self.c
            self.a, self.c = total & 0xFF, int(total < 0)
        elif op in ("anl", "orl", "xrl"):
            one, other = self.get(first), self.get(second)
            self.put(first, {"anl": one & other, "orl": one | other, "xrl": one ^ other}[op])
        elif op in ("inc", "dec"):
            self.put(first, self.get(first) + (1 if op == "inc" else -1))
        elif op in ("clr", "setb"):
            self.put(first, int(op == "setb"))
        elif op == "cpl":
            self.put(first, self.get(first) ^ (0xFF if first == "a" else 1))
        elif op == "swap":
            self.a = self.a << 4 & 0xF0 | self.a >> 4
        elif op == "rlc":
            total = self.a << 1 | self.c
            self.a, self.c = total & 0xFF, total >> 8
        elif op == "rr":
            self.a = self.a >> 1 | self.a << 7 & 0x80
        elif op == "push":
            self.stack.append(self.get(first))
        elif op == "pop":
            self.put(first, self.stack.pop())
        else:
            raise ValueError(op)
        return False


class Writer:
    """Random code in SDCC's manner: pieces that leave the stack as it was, branches forward, one loop."""

    def __init__(self, dice, name):
        self.dice, self.name, self.labels, self.open, self.once = dice, name, 100, [], False
        self.own = [n for n in EXTERNAL if n.startswith(name + "_")]

    def pick(self, *choices):
        return self.dice.choice(choices)

    def register(self):
        return f"r{self.dice.randrange(8)}"

    def variable(self):
        name = self.pick("_g", "_h", "_p", "_v", "_PORT", "_g", "_h", "_p", self.name + "_sloc0_1_0",
                         *["_k"] * (self.name == "_e"))
        return self.pick(name, f"({name} + 1)") if name not in ("_v", "_PORT") else name

    def place(self):
        name = self.pick("_x", "_y", "_w", *self.own, *self.own)
        return self.pick(name, name, f"({name} + 0x0001)", f"({name} + 0x0002)")

    def value(self):
        return self.pick(f"#0x{self.pick(0, 0, 1, 2, 13, 14, 0x0F, 0xFF):02x}", self.register(), self.register(), self.variable(), "a")

    def piece(self):
        d, r, v, place = self.dice, self.register(), self.variable(), self.place()
        kind = d.randrange(31)
        if kind < 3:
            return [f"mov a,{self.pick(r, v, '#0x05', 'dpl')}"]
        if kind < 6:
            source = self.value()
            to = self.pick(r, v, "dpl") if source == "a" or source[0] != "r" else self.pick(v, "dpl")
            return [f"mov {to},{source}"]
        if kind < 9:
            return [f"mov dptr,#{place}", self.pick("movx a,@dptr", "movx @dptr,a")] + self.pick(
                [], ["inc dptr", self.pick("movx a,@dptr", "movx @dptr,a")], [f"mov {r},a"])
        if kind < 11:
            return [f"{self.pick('add', 'addc', 'subb', 'anl', 'orl', 'xrl')} a,{self.pick('#0x0e', r, r, v)}"]
        if kind == 11:
            return [self.pick("inc a", "dec a", f"inc {r}", f"inc {v}", "cpl a", "swap a", "rlc a", "rr a", "clr a", "clr c", "setb c", "cpl c")]
        if kind == 12:
            low, high = self.pick(("_p", "(_p + 1)"), ("r6", "r7"))
            set_up = ["mov r6,#_x", "mov r7,#(_x >> 8)"] if low == "r6" else ["mov _p,#_y", "mov (_p + 1),#(_y >> 8)"]
            return self.pick(set_up, []) + set_up + [f"mov dpl,{low}", f"mov dph,{high}"] + ["inc dptr"] * d.randrange(7) + [
                self.pick("movx a,@dptr", "movx @dptr,a")]
        if kind == 26:
            return self.sums()
        if kind > 27:
            return self.truth()
        if kind == 27:
            where = self.pick(r, v)
            return [f"mov a,{where}", self.pick("inc a", "dec a"), f"mov {where},a"]
        if kind == 22:
            turns = d.randrange(1, 4)
            self.labels += turns
            return ["mov _p,#_y", "mov (_p + 1),#(_y >> 8)"] + [line for n in range(turns) for line in (
                "mov dpl,_p", "mov dph,(_p + 1)", f"mov a,{self.pick(r, v)}", "movx @dptr,a", "inc _p", "clr a",
                f"cjne a,_p,{self.labels - n:05d}$", "inc (_p + 1)", f"{self.labels - n:05d}$:")]
        if kind == 13:
            at = self.pick("r0", "r1")
            return [f"mov {at},#{self.pick('_i', '_j', '(_i + 1)')}", self.pick(f"mov a,@{at}", f"mov @{at},a", f"mov ar5,@{at}", f"mov @{at},#0x03")]
        if kind == 14:
            at = self.pick("r0", "r1")
            return [f"mov a,#0x{self.pick(1, 2, 3):02x}", self.pick("add a,#_q", "add a,r4" if d.random() < .2 else "add a,#_u"),
                    f"mov {at},a", self.pick(f"movx a,@{at}", f"movx @{at},a")]
        if kind == 15:
            return [f"mov {r},{v}", f"{self.pick('anl', 'orl')} a{r},{self.pick('#0x0f', 'a')}", f"mov a,{r}"]
        if kind in (16, 24) and self.name == "_f":
            saved = [f"r{n}" for n in range(8) if d.random() < .4]
            return [f"mov dpl,{r}"] + [f"push a{n}" for n in saved] + [f"lcall {self.callee(kind)}"] + \
                [f"pop a{n}" for n in reversed(saved)] + self.pick([f"mov {r},dpl"], [])
        if kind in (23, 25) and self.name != "_t":  # back from the middle, or on into another function
            self.labels += 1
            there = "_t" if self.name == "_f" else "_d"
            return [f"{self.pick('jz', 'jnc')} {self.labels:05d}$", self.pick("ret", f"ljmp {there}"), f"{self.labels:05d}$:"]
        if kind == 17:
            bit = self.pick("_bit", "_f_sloc1_1_0") if self.name == "_f" else "_bit"
            return [self.pick(f"mov c,{bit}", f"mov {bit},c", f"setb {bit}", f"clr {bit}")]
        if kind < 20 and len(self.open) < 3:
            self.labels += 1
            label = f"{self.labels:05d}$"
            self.open.append(label)
            return [self.pick(f"jz {label}", f"jnz {label}", f"jc {label}", f"jb acc.2,{label}", f"jnb _bit,{label}",
                              f"cjne {r},#0x00,{label}", f"cjne a,{v},{label}", f"cjne a,a{r},{label}")]
        if self.open:
            label = self.open.pop(d.randrange(len(self.open)))
            if d.random() < .3:
                self.labels += 1
                self.open.append(f"{self.labels:05d}$")
                return [f"sjmp {self.open[-1]}", label + ":"]
            return [label + ":"]
        return []

    def sums(self):
        """Places some octets before or behind a pointer's, found by sums of 16 bits."""
        low, high = self.pick(("_p", "(_p + 1)"), ("r6", "r7"))
        code = [f"mov {low},#_y", f"mov {high},#(_y >> 8)"] + self.pick([], [f"mov dpl,{low}", f"mov dph,{high}", "movx a,@dptr"])
        offset = self.dice.randrange(6)
        for _ in range(self.dice.randrange(1, 5)):
            first, spare = self.pick("mov dpl,a", "mov r5,a"), self.pick([], ["movx @dptr,a"])
            code += spare + [f"mov a,#0x{offset & 0xFF:02x}", f"add a,{low}", first, *self.pick(
                ("clr a", f"addc a,{high}") if offset >= 0 else (f"mov a,{high}", "addc a,#0xff"), (
                    f"mov a,{high}", f"addc a,#0x{offset >> 8 & 0xFF:02x}"))] + ["mov dpl,r5"] * (first == "mov r5,a") + [
                "mov dph,a", self.pick(f"mov a,{self.register()}", "movx a,@dptr"), self.pick("movx a,@dptr", "movx @dptr,a")]
            offset += self.pick(1, 1, 1, 0, 2, -1)
            if self.dice.random() < .3:
                code += [f"mov dpl,{low}", f"mov dph,{high}", "inc dptr", "movx a,@dptr"]
            if self.dice.random() < .2 and low == "r6":
                code += [f"mov a,#0x01", "add a,r6", "mov r6,a", "clr a", "addc a,r7", "mov r7,a"]
        return code

    def truth(self):
        """A comparison's result in a bit or in an octet, looked at again."""
        self.labels += 4
        no, on, over, end = (f"{self.labels - n:05d}$" for n in range(4))
        bit, to = "_f_sloc1_1_0" if self.name == "_f" else "c", self.pick("dpl", "r6", "r7")
        test = self.pick(f"jz {no}", f"jc {no}", f"cjne {self.register()},#0x02,{no}", f"jnb _bit,{no}", f"cjne a,{self.variable()},{no}")
        if self.dice.random() < .5:
            code = [test, f"mov {to},#0x{self.pick(0, 1, 5):02x}", f"sjmp {on}", f"{no}:", f"mov {to},#0x{self.pick(0, 0, 1):02x}", f"{on}:"]
        else:
            code = [test, f"setb {bit}", f"sjmp {on}", f"{no}:", f"clr {bit}", f"{on}:"] + [f"mov c,{bit}"] * (bit != "c") + \
                self.pick(["cpl c"], []) + ["clr a", "rlc a", f"mov {to},a"]
        look = self.pick(["mov a," + to, self.pick("jz", "jnz") + f" {over}"], ["mov a," + to, f"cjne a,#0x01,{over}"],
                         ["mov a," + to, f"jnb acc.0,{over}"], [f"mov r7,{to}"] * (to == "dpl") + [f"cjne r7,#0x00,{over}"],
                         ["mov a," + to, "add a,#0xff", self.pick("jc", "jnc") + f" {over}"])
        then = self.pick([f"mov {self.variable()},#0x07", f"sjmp {end}"], [f"mov {self.variable()},{self.register()}"], ["ret"])
        return code + look + then + [f"{over}:", f"mov {self.variable()},{self.pick('a', to)}", f"{end}:"]

    def callee(self, kind):
        """_e is called once."""
        name = "_e" if kind == 24 and not self.once else "_c"
        self.once = self.once or name == "_e"
        return name

    def code(self, pieces):
        code = [line for _ in range(pieces) for line in self.piece()] + [label + ":" for label in self.open]
        self.open = []
        if self.dice.random() < .4 and self.name == "_f":
            body = [line for _ in range(6) for line in self.piece() if "_n" not in line] + [label + ":" for label in self.open]
            code += ["mov _n,#0x03", "00099$:"] + body + ["djnz _n,00099$"]
        return code + self.pick(["ret"], ["mov dpl,a", "ret"], ["lcall _d", "ret"])


def functions(dice, *names):
    return "".join(f"{name}:\n\tar0 = 0x00\n" + "".join(
        line + "\n" if line.endswith(":") else f"\t{line}\n" for line in Writer(dice, name).code(dice.randrange(*sizes)))
        for name, sizes in names)


def texts(dice):
    """-> of the files"""
    return (head(lambda name: name not in ELSEWHERE) + functions(dice, ("_f", (5, 30)), ("_t", (1, 6))) +
            "_main:\n\tmov\tdpl,_g\n\tlcall\t_f\n\tmov\t_g,dpl\n\tret\n",
            head(lambda name: name in ELSEWHERE) + functions(dice, ("_c", (1, 9)), ("_e", (3, 9))) +
            "_d:\n\tmov\t_h,r3\n\tmov\tdpl,#0x07\n\tret\n")


def observe(program, seed):
    chip, seen = Chip(program, seed), []
    for turn in range(3):
        chip.start(3 * seed + turn)
        chip.call("_main")
        seen.append([chip.direct[at + n] for name, at in (DIRECT | INDIRECT).items() if "sloc" not in name for n in (0, 1)]
                    + [chip.external[at + n] for name, at in (EXTERNAL | PAGED).items() if "65536" not in name
                       for n in range(5)] + [chip.bits["_bit"]])
    return seen, chip.trace


def run(number, folder):
    dice = random.Random(number)
    files = [str(Path(folder) / f"{name}.asm") for name in "xy"]
    context = dice.choice(("", "_isr", "_isr"))
    for file, text in zip(files, texts(dice)):
        Path(file).write_text(re.sub(r"\b_([fctde])\b", rf"_\1{context}", text))
    before, after = (Program(files, dict.fromkeys(files, {"v", "w"})) for _ in range(2))
    tidy(after)
    after.write()
    figures = [sum(1 for f in program.functions for line in f.code if line.op) for program in (before, after)]
    figures.append(len(before.functions) - len(after.functions))
    for seed in range(4):
        if observe(before, seed) != observe(after, seed):
            return figures, f"program {number}, start {seed}"
    return figures, None


def main(arguments):
    programs = int(arguments[0]) if arguments else 400 if os.environ.get("TEST_FULL") else 50
    first = int(arguments[1]) if arguments[1:] else 1
    wrong, total = [], [0, 0, 0]
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + programs):
            figures, problem = run(number, folder)
            total = [a + b for a, b in zip(total, figures)]
            wrong += [problem] * bool(problem)
    print(f"{programs} programs of {total[0]} instructions, {total[1]} after tidy, {total[2]} functions where they were called; "
          f"every one does the same:{'FAIL: ' + ', '.join(wrong[:9]) if wrong else 'PASS'}")
    print(f"-----------------------\n1 Tests {int(bool(wrong))} Failures 0 Ignored")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
