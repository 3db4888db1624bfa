#!/usr/bin/env python3
"""Prove from SDCC's assembly that interrupts and the main loop do not meet in a function's static locals.

usage: check_contexts.py [--sources DIR] ... FILE.asm ...

On the 8051 the locals of a function are static memory. A function that the main loop is in while an interrupt
calls it is corrupted, and no tool says so. The names carry the context (house rule: interrupt code ends in
_isr), so the rules can be checked call by call, on what the compiler made of the source:

  1  interrupt code (*_isr) calls interrupt code, the services in ALLOWED, and bare functions; nothing else. A bare
     function calls nothing and uses no register and no memory of its own: it only sets variables to constants;
  2  interrupt code calls none of SDCC's helpers (__mulint, __divuint, __gptrget ...): some are not reentrant, and
     all cost more than an octet interrupt has;
  3  other code calls interrupt code only while interrupts are masked: on every path through the function there
     are more hal_irq_save() than hal_irq_restore() calls before it; a function returns with as many as it took;
  4  a function called through a pointer is interrupt code if and only if its caller is;
  5  no variable of interrupt code is overlaid with another function's (area OSEG);
  6  interrupt code does not select register bank 0 for anybody: that is the main loop's, and SDCC selects it for a
     function without IN_ISR, REENTRANT or not;
  7  where the files are a whole image, every interrupt function has its vector: SDCC leaves it out, without a word,
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
        elif current and not op.startswith(".") and not operands.startswith("="):
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


def is_bare(function):
    """Safe in any context: variables set to constants, and return."""
    for op, operands in function.code:
        if op not in ("ret", "clr", "setb", "mov") or f"_{function.name}_" in operands:
            return False
        if re.search(r"@|\b(a|b|c|ab|acc|psw|sp|dptr|dpl|dph|a?r[0-7])\b", operands):
            return False
        if op == "mov" and ",#" not in operands.replace(" ", ""):
            return False
    return bool(function.code)


def check_calls(function, handlers, bare):
    """Rules 1 to 4 for one function."""
    inside = is_interrupt(function.name)
    depths = lock_depths(function)
    for index, callee in calls(function):
        if callee is None:
            wrong = sorted(h for h in handlers if is_interrupt(h) != inside)
            if wrong:
                yield f"calls through a pointer, which may be {', '.join(wrong)}"
            elif inside and not handlers:
                yield "calls through a pointer that is filled in another file"
        elif callee in ANYWHERE or callee in bare:
            continue
        elif inside and callee.startswith("_"):
            yield f"calls SDCC's helper {callee}"
        elif inside and not is_interrupt(callee):
            yield f"calls {callee}, which is not interrupt code"
        elif not inside and is_interrupt(callee) and 0 in depths.get(index, {0}):
            yield f"calls {callee} with interrupts on"


def check_returns(function):
    """A function gives back as many locks as it took."""
    if LOCK not in {callee for _, callee in calls(function)} or function.name in (LOCK, UNLOCK):
        return
    depths = lock_depths(function)
    for index, (op, operands) in enumerate(function.code):
        leaves = op in ("ret", "reti") or (op in ("ljmp", "ajmp") and operands.startswith("_"))
        given_back = 1 if operands == "_" + UNLOCK else 0
        if leaves and max(depths.get(index, {0})) - given_back > 0:
            yield "returns with interrupts masked"


def check_bank(function, bare):
    """Rule 6."""
    made = dict(calls(function))
    for index, (op, operands) in enumerate(function.code):
        if op == "mov" and operands.replace(" ", "") == "psw,#0x00" and is_interrupt(function.name):
            callee = made.get(index + 1)
            if callee not in ANYWHERE and callee not in bare:
                yield f"selects the main loop's registers for {callee}"


def check(path, parsed, bare):
    functions, handlers, overlaid = parsed
    for function in functions:
        for problems in (check_calls(function, handlers, bare), check_returns(function), check_bank(function, bare)):
            for problem in problems:
                yield f"{path}: {function.name}: {problem}"
    for variable in overlaid:
        if any(is_interrupt(f.name) and variable.startswith(f.name + "_") for f in functions):
            yield f"{path}: {variable}: a variable of interrupt code is overlaid with others (compile with --nooverlay)"


def vectorless(folders, paths):
    """Interrupt functions of these files that the vector table of one of them does not name (rule 7)."""
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
    parsed = {path: parse(path) for path in arguments}
    bare = {f.name for functions, _, _ in parsed.values() for f in functions if is_bare(f)}
    problems = [problem for path in arguments for problem in check(path, parsed[path], bare)]
    problems += vectorless(folders, arguments)
    count = sum(len(functions) for functions, _, _ in parsed.values())
    print("\n".join(problems) if problems else f"contexts: {count} functions in {len(arguments)} files keep apart")
    if not arguments or not count:
        print("contexts: nothing to check")
        return 1
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
