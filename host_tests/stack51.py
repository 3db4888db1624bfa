"""The deepest stack of an 8051 image, by its calls.

Main loop and one interrupt of each priority in use, each at its deepest: an interrupt waits for the end of one of the
same priority and breaks into one of a lower. What it costs is the return address, what it saves, and what it calls.
Nothing is left out for being unlikely: measured depths are smaller, and must be (s51_dp.py, hdlc_chip.py).

A recursion, a call through a pointer to nowhere, or a change of the stack pointer that cannot be followed is an error.
"""
import re

from asm51 import RETURNS, load

NEVER_RETURNS = {"hal_reset"}  # leaves by reti to an address it has pushed
# Bits of IE and IP: Intel MCS-51 8-bit microcontroller hardware description; 6 is the PCA of the 87C51FB.
INTERRUPTS = {0: ("EX0", "PX0"), 1: ("ET0", "PT0"), 2: ("EX1", "PX1"), 3: ("ET1", "PT1"), 4: ("ES", "PS"),
              5: ("ET2", "PT2"), 6: ("EC", "PPC")}


class Unknown(Exception):
    """The text says what cannot be told, and where."""


def vector(number):
    return 3 + 8 * number


def _constants(program, register, bits):
    """Numbers of the bits that the program sets in a register, IE or IP; a value that is no constant is Unknown."""
    found = set()
    for function in program.functions:
        for op, operands in function.code:
            first, _, second = operands.replace(" ", "").partition(",")
            name = first.lstrip("_").upper()  # C's or the assembler's own
            if name in bits and op in ("setb", "mov", "cpl"):
                found.add(bits[name])
            elif name == register and op not in ("push", "anl"):
                value = re.match(r"#(0x[0-9a-fA-F]+|\d+)$", second)
                if op not in ("mov", "orl") or not value:
                    raise Unknown(f"{function.name}: {op} {operands}: no constant")
                found |= {n for n in range(7) if int(value[1], 0) >> n & 1}
    return found


def enabled(program):
    """Numbers of the interrupts the program enables somewhere."""
    return _constants(program, "IE", {enable: n for n, (enable, _) in INTERRUPTS.items()})


def by_priority(program):
    """-> {priority: [functions of the interrupts that are enabled]}"""
    high = _constants(program, "IP", {priority: n for n, (_, priority) in INTERRUPTS.items()})
    if _constants(program, "IPH", {}):
        raise Unknown("four priorities are not known here")
    found = {}
    for number in sorted(enabled(program)):
        name = program.image.target(vector(number))
        handler = name and program.resolve(None, name[1:])
        if handler:
            found.setdefault(int(number in high), []).append(handler)
    return found


class Depths:
    def __init__(self, program):
        self.program = program
        self.known = {}
        self.deepest = {}  # function -> the callee it is deepest in
        self.active = []

    def of(self, function):
        """Octets on the stack above the function's return address, at most."""
        if function in self.active:
            circle = self.active[self.active.index(function):] + [function]
            raise Unknown("recursion: " + " > ".join(f.name for f in circle))
        if function not in self.known:
            self.active.append(function)
            self.known[function] = self._follow(function)
            self.active.pop()
        return self.known[function]

    def _follow(self, function):
        callees = {}
        for index, callee, name in self.program.callees(function):
            if callee is None:
                raise Unknown(f"{function.name}: calls {name}, which is nowhere")
            callees.setdefault(index, []).append(callee)
        pointers = {index for index, name in function.calls() if name is None}
        depths, work, worst = {0: (0, None)}, [0], 0
        while work:
            index = work.pop()
            before, frame = depths[index]
            after, frame = self._effect(function, index, before, frame)
            called = function.code[index][0] in ("lcall", "acall")
            worst = max(worst, after, before + 2 if called else 0)
            if index in pointers:
                worst = max(worst, before + 4)
                if index not in callees:
                    raise Unknown(f"{function.name}: calls through a pointer, and no function's address is taken")
            for callee in callees.get(index, []):
                depth = before + 2 * called + self.of(callee)
                if depth >= worst:
                    worst, self.deepest[function] = depth, callee
            for following in function.successors(index):
                if following not in depths:
                    depths[following] = (after, frame)
                    work.append(following)
                elif depths[following][0] != after:
                    raise Unknown(f"{function.name}: two depths of the stack meet")
        return worst

    @staticmethod
    def _effect(function, index, depth, frame):
        """-> octets on the stack after the instruction, and where the frame pointer of a reentrant function is"""
        op, operands = function.code[index]
        operands = operands.lower().replace(" ", "")
        if op in RETURNS and depth and function.name not in NEVER_RETURNS:
            raise Unknown(f"{function.name}: returns with {depth} octets on the stack")
        if op == "push" or (op, operands) == ("inc", "sp"):
            return depth + 1, frame
        if (op == "pop" and operands != "sp") or (op, operands) == ("dec", "sp"):
            if depth == 0:
                raise Unknown(f"{function.name}: takes off the stack what it has not put there")
            return depth - 1, frame
        if (op, operands) == ("mov", "_bp,sp"):
            return depth, depth
        if (op, operands) == ("mov", "sp,_bp") and frame is not None:
            return frame, frame
        if op == "moves sp" or re.match(r"_?sp\b|0x81\b", operands):
            raise Unknown(f"{function.name}: {op} {operands}: where the stack pointer is cannot be told")
        return depth, frame

    def path(self, function):
        names = [function.name]
        while function in self.deepest:
            function = self.deepest[function]
            names.append(function.name)
        return names


class Stack:
    """main: octets of the main loop; levels: {priority: octets}; paths: the calls that lead there"""

    def __init__(self, program):
        depths = Depths(program)
        main = program.resolve(None, "main")
        self.main, self.levels, self.paths = depths.of(main), {}, [depths.path(main)]
        for level, handlers in sorted(by_priority(program).items()):
            worst = max(handlers, key=depths.of)
            self.levels[level] = 2 + depths.of(worst)
            self.paths.append(depths.path(worst))
        # start-up calls one routine, with interrupts off
        self.worst = max(2, self.main + sum(self.levels.values()))


def measured_and_computed(ihx, highest_sp):
    """Octets of an image's stack when the stack pointer was highest in a run, and those its calls allow. Were the first
    more than the second, something would be missing here."""
    program = load(ihx)
    return highest_sp + 1 - program.image.stack_start, Stack(program).worst
