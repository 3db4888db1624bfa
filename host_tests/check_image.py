#!/usr/bin/env python3
"""What a linked 8051 image does in interrupts.

usage: check_image.py [--root DIR] IMAGE.ihx ...     IMAGE/ holds the .asm files, DIR the .c files they were made of

  1  every __interrupt function of the sources has its vector in the image: SDCC leaves it out, without a word, when the
     function's prototype is not visible in the file that holds main();
  2  the vector of every interrupt the program enables leads to the __interrupt function of that number, and its name
     ends in _isr;
  3  what is reached from the vectors, over any number of calls, is interrupt code (check_contexts.py), and no routine
     of SDCC's library: no generic pointer, no multiplication or division but the core's own MUL AB and DIV AB;
  4  interrupts of different priority reach disjoint functions and register banks: one breaks into the other, and locals
     are static; but a function without memory and registers of its own, other than A, may be shared;
  5  where the lock leaves interrupts on, what the main loop reaches does not select the interrupt functions' register
     bank: they run on in it.
"""
import re
import sys
from pathlib import Path

from asm51 import load
from check_contexts import ANYWHERE, LOCK, is_bare, is_interrupt, is_stateless
from stack51 import INTERRUPTS, Unknown, by_priority, enabled, vector

DEFINITION = re.compile(r"\b(\w+)\s*\([^;{}()]*\)\s*__interrupt\s*\(([^)]*)\)[^;{}]*\{")


def defined_interrupts(root, ihx, program):
    """-> {name: number} of the __interrupt functions in the sources of what is linked"""
    found = {}
    for path, source in program.sources.items():
        text = (Path(root) / Path(path).relative_to(Path(ihx).with_suffix(""))).with_suffix(".c").read_text()
        for name, number in DEFINITION.findall(text):
            if "_" + name in program.image.code and any(f.name == name for f in source.functions):
                found[name] = int(number)
    return found


def check_vectors(program, defined):
    """Rules 1 and 2."""
    for name, number in defined.items():
        target = program.image.target(vector(number))
        if target != "_" + name:
            yield (f"{name}: has no vector: {vector(number):04X} leads to {target}; "
                   "show its prototype to the file that holds main()")
    for number in enabled(program):
        target = program.image.target(vector(number)) or "no function"
        if defined.get(target[1:]) != number:
            yield (f"{INTERRUPTS[number][0]} is set, and {vector(number):04X} leads to {target}, "
                   f"no __interrupt({number})")
        elif not is_interrupt(target[1:]):
            yield f"{target[1:]}: the name of interrupt code ends in _isr"


def path_to(function, reached):
    names = []
    while function:
        names.insert(0, function.name)
        function = reached[function]
    return " > ".join(names)


def anywhere(function):
    return function.name in ANYWHERE or (function.path and is_bare(function))


def check_reached(program):
    """Rules 3 and 4."""
    seen = {}
    for level, handlers in by_priority(program).items():
        reached = program.reached_from(handlers)
        for function in reached:
            if function.path is None:
                yield f"{path_to(function, reached)}: a routine of SDCC's library in interrupt code"
            elif not is_interrupt(function.name) and not anywhere(function):
                yield f"{path_to(function, reached)}: not interrupt code"
            elif not anywhere(function) and not is_stateless(function) and seen.setdefault(function, level) != level:
                yield f"{path_to(function, reached)}: interrupts of two priorities run it"
            for bank in banks(function):
                if seen.setdefault(bank, level) != level:
                    yield f"{path_to(function, reached)}: interrupts of two priorities use register bank {bank >> 3}"


def banks(function):
    """Register banks that a function selects, in order."""
    return [int(n, 16) for op, operands in function.code if op == "mov"
            for n in re.findall(r"^psw,#(0x[0-9a-f]+)$", operands.replace(" ", ""))]


def left_on(program):
    """Functions of the interrupts that the lock does not mask."""
    lock = program.resolve(None, LOCK)
    masked = {operands.split(",")[0].lstrip("_") for op, operands in lock.code if op in ("clr", "jbc")} if lock else {"EA"}
    for number in () if "EA" in masked else enabled(program):
        name = program.image.target(vector(number))
        if name and INTERRUPTS[number][0] not in masked:
            yield program.resolve(None, name[1:])


def check_banks(program):
    """Rule 5."""
    reached = program.reached_from([program.resolve(None, "main")])
    # an interrupt function's own bank is the first it selects
    taken = {bank for entry in left_on(program) for bank in banks(entry)[:1]}
    for function in reached:
        if taken & set(banks(function)):
            yield f"{path_to(function, reached)}: selects the register bank of interrupts that the lock leaves on"


def check(root, ihx):
    program = load(ihx)
    try:
        yield from check_vectors(program, defined_interrupts(root, ihx, program))
        yield from check_reached(program)
        yield from check_banks(program)
    except Unknown as unknown:
        yield str(unknown)


def main(arguments):
    root = "."
    if arguments[:1] == ["--root"]:
        root, arguments = arguments[1], arguments[2:]
    problems = [f"{ihx}: {problem}" for ihx in arguments for problem in check(root, ihx)]
    print("\n".join(problems) if problems else f"images: {len(arguments)} keep interrupts apart")
    return 1 if problems or not arguments else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
