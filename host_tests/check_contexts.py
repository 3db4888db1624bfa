#!/usr/bin/env python3
"""Prove from SDCC's assembly that interrupts and the main loop do not meet in a function's static locals.

usage: check_contexts.py [--sources DIR] ... FILE.asm ...

On the 8051 the locals of a function are static memory. A function that the main loop is in while an interrupt
calls it is corrupted, and no tool says so. The names carry the context (house rule: interrupt code ends in
_isr), so the rules can be checked call by call, on what the compiler made of the source:

  1  interrupt code (*_isr) calls interrupt code, the services in ALLOWED, and REENTRANT functions; nothing else;
  2  interrupt code calls none of SDCC's helpers (__mulint, __divuint, __gptrget ...): some are not reentrant, and
     all cost more than an octet interrupt has;
  3  other code calls interrupt code only while interrupts are masked: on every path through the function there
     are more hal_irq_save() than hal_irq_restore() calls before it; a function returns with as many as it took;
  4  a function called through a pointer is interrupt code if and only if its caller is;
  5  no variable of interrupt code is overlaid with another function's (area OSEG);
  6  where the files are a whole image, every interrupt function has its vector: SDCC leaves it out, without a word,
     when the function's prototype is not visible in the file that holds main().

By 1, 3 and 4 the functions reachable from interrupts and those reachable from unmasked main code are disjoint.
"""
import re
import sys
from pathlib import Path

# Services of the port that interrupt code may call and main may call only under the lock (hal.h).
ALLOWED = {"hal_silence", "hal_send"}
# May be called from anywhere: it does not return.
ANYWHERE = {"hal_reset"}
LOCK, UNLOCK = "hal_irq_save", "hal_irq_restore"

LABEL = re.compile(r"^(\w+\$|[A-Za-z_]\w*)::?")
CONDITIONAL = {"jz", "jnz", "jc", "jnc", "jb", "jnb", "jbc", "cjne", "djnz"}


def is_interrupt(name):
    return name.endswith("_isr") or name in ALLOWED


class Function:
    def __init__(self, name):
        self.name = name
        self.code = []    # (mnemonic, operands)
        self.labels = {}  # local label -> index into code


def parse(path):
    """-> functions, functions whose address is taken, overlaid variables"""
    functions, overlaid = [], []
    in_tables, in_code, data = set(), set(), set()
    area, current = "", None
    for line in Path(path).read_text(errors="replace").splitlines():
        line = line.split(";")[0].rstrip()
        label = LABEL.match(line)
        if label:
            name, line = label.group(1), line[label.end():]
            if name.endswith("$"):
                if current:
                    current.labels[name] = len(current.code)
            elif area in ("CSEG", "HOME") and name.startswith("_") and name != "__interrupt_vect":
                current = Function(name[1:])
                functions.append(current)
            else:
                data.add(name[1:])
                if area == "OSEG":
                    overlaid.append(name[1:])
        words = line.split(None, 1)
        if not words:
            continue
        op, operands = words[0].lower(), words[1].strip() if len(words) > 1 else ""
        if op == ".area":
            area, current = operands.split()[0], None
        elif op in (".byte", ".db", ".word", ".dw"):
            if current:
                current.code.append((op, operands))
            else:
                in_tables |= {n[1:] for n in re.findall(r"\b_\w+", operands)}
        elif current and not op.startswith(".") and "=" not in op:
            current.code.append((op, operands))
            if op == "mov" and "#" in operands:  # the address of a function passed or stored by code
                in_code |= {n[1:] for n in re.findall(r"#\(?(_\w+)", operands)}
    defined = {f.name for f in functions}
    return functions, (in_tables - data) | (in_code & defined), overlaid


def calls(function):
    """(index, callee) of every call; callee None for a call through a pointer."""
    for index, (op, operands) in enumerate(function.code):
        if op in ("lcall", "acall"):
            target = operands.split()[0]
            local = re.match(r"^\d+\$", target) or target == "__sdcc_call_dptr"
            yield index, None if local else target[1:]
        elif op in ("ljmp", "ajmp", "sjmp") and operands.startswith("_"):
            yield index, operands[1:]


def successors(function, index):
    op, operands = function.code[index]
    code, labels = function.code, function.labels
    if op in ("ret", "reti"):
        return []
    if op in ("ljmp", "ajmp", "sjmp"):
        return [labels[operands]] if operands in labels else []
    if op == "jmp":  # a switch: the jumps that follow, or the labels of its table of addresses
        targets = {labels[n] for o, text in code if o in (".db", ".byte") for n in re.findall(r"\d+\$", text)}
        i = index + 1
        while i < len(code) and code[i][0] in ("ljmp", "ajmp", "sjmp"):
            targets.add(i)
            i += 1
        return sorted(targets)
    if op in (".db", ".byte"):
        return []
    if op in ("lcall", "acall") and re.match(r"^\d+\$", operands):
        # SDCC's indirect call: the callee's address is pushed at the local label, its ret goes there
        return [index + 1]
    following = [index + 1] if index + 1 < len(code) else []
    if op in CONDITIONAL:
        target = operands.split(",")[-1].strip()
        return following + ([labels[target]] if target in labels else [])
    return following


def lock_depths(function):
    """-> {index: possible numbers of saved interrupt masks when the instruction starts}"""
    made = {index: callee for index, callee in calls(function)}
    depths = {0: {0}}
    work = [(0, 0)]
    while work:
        index, depth = work.pop()
        if index >= len(function.code):
            continue
        after = depth + {LOCK: 1, UNLOCK: -1}.get(made.get(index), 0)
        if after < 0 or after > 8:
            after = max(0, min(after, 8))
        for following in successors(function, index):
            if after not in depths.setdefault(following, set()):
                depths[following].add(after)
                work.append((following, after))
    return depths


def check(path, reentrant):
    functions, handlers, overlaid = parse(path)
    problems = []

    def problem(function, text):
        problems.append(f"{path}: {function}: {text}")

    for function in functions:
        name, inside = function.name, is_interrupt(function.name)
        depths = None
        for index, callee in calls(function):
            if callee is None:
                wrong = sorted(h for h in handlers if is_interrupt(h) != inside)
                if wrong:
                    problem(name, f"calls through a pointer, which may be {', '.join(wrong)}")
                elif inside and not handlers:
                    problem(name, "calls through a pointer that is filled in another file")
            elif callee in ANYWHERE or callee in reentrant:
                continue
            elif inside or name in reentrant:
                if callee.startswith("_"):
                    problem(name, f"calls SDCC's helper {callee}")
                elif not is_interrupt(callee) or name in reentrant:
                    problem(name, f"calls {callee}, which is not interrupt code")
            elif is_interrupt(callee):
                depths = depths or lock_depths(function)
                if 0 in depths.get(index, {0}):
                    problem(name, f"calls {callee} with interrupts on")
        if LOCK in {c for _, c in calls(function)} and name not in (LOCK, UNLOCK):
            if inside:
                problem(name, "masks interrupts in interrupt code")
            depths = depths or lock_depths(function)
            for index, (op, operands) in enumerate(function.code):
                leaves = op in ("ret", "reti") or (op in ("ljmp", "ajmp") and operands.startswith("_"))
                restores = operands == "_" + UNLOCK
                if leaves and max(depths.get(index, {0})) - (1 if restores else 0) > 0:
                    problem(name, "returns with interrupts masked")
    for variable in overlaid:
        if any(is_interrupt(f.name) and variable.startswith(f.name + "_") for f in functions):
            problem(variable, "a variable of interrupt code is overlaid with others (compile with --nooverlay)")
    return problems, len(functions)


def reentrant_functions(folders):
    found = set()
    for folder in folders:
        for path in Path(folder).rglob("*.[ch]"):
            found |= set(re.findall(r"\b(\w+)\s*\([^;{}()]*\)\s*REENTRANT\b", path.read_text()))
    return found


def vectorless(folders, paths):
    """Interrupt functions of these files that the vector table of one of them does not name (rule 6)."""
    texts = [Path(path).read_text(errors="replace") for path in paths]
    tables = [text for text in texts if "__interrupt_vect:" in text]
    if not tables:
        return
    vectors = set(re.findall(r"\bljmp\s+_(\w+)", tables[0].split("__interrupt_vect:")[1].split(".area")[0]))
    for folder in folders:
        for source in Path(folder).rglob("*.c"):
            for name in re.findall(r"\b(\w+)\s*\([^;{}()]*\)\s*__interrupt\s*\(\d+\)[^;{}]*\{", source.read_text()):
                if name not in vectors and any(re.search(rf"^_{name}:", text, re.M) for text in texts):
                    yield f"{source}: {name}: has no vector; show its prototype to the file that holds main()"


def main(arguments):
    folders = []
    while arguments and arguments[0] == "--sources":
        folders.append(arguments[1])
        arguments = arguments[2:]
    reentrant = reentrant_functions(folders)
    problems, count = [], 0
    for path in arguments:
        found, functions = check(path, reentrant)
        problems += found
        count += functions
    problems += vectorless(folders, arguments)
    print("\n".join(problems) if problems else f"contexts: {count} functions in {len(arguments)} files keep apart")
    if not arguments or not count:
        print("contexts: nothing to check")
        return 1
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
