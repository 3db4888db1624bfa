"""What SDCC made of 8051 sources: its assembly, function by function, and the image the linker made of it.

    program = Program(["a.asm", "b.asm"])       what was compiled
    program = load("build/87c51fb/x.ihx")       what was linked, with the library's routines, decoded from the image

A function's code is a list of (mnemonic, operands); assembly written by hand is code like any other. Where one function
runs on into the next label, that counts as a jump there.
"""
import re
from pathlib import Path

LABEL = re.compile(r"^(\w+\$|[A-Za-z_.]\w*)::?")
BRANCHES = {"jz", "jnz", "jc", "jnc", "jb", "jnb", "jbc", "cjne", "djnz"}
JUMPS = {"ljmp", "ajmp", "sjmp"}
CALLS = {"lcall", "acall"}
RETURNS = {"ret", "reti"}
BY_POINTER = "_sdcc_call_dptr"  # the library's indirect call: jumps to dptr


class Function:
    def __init__(self, name, path):
        self.name = name  # as in C
        self.path = path  # None: of the library
        self.code = []    # (mnemonic, operands)
        self.labels = {}  # local label -> index into code

    def calls(self):
        """(index, callee) of every call and of every jump to another function; callee None: through a pointer."""
        for index, (op, operands) in enumerate(self.code):
            if op in CALLS:
                local = re.match(r"^\d+\$", operands) or operands == "_" + BY_POINTER
                yield index, None if local else operands[1:]
            elif op in JUMPS | BRANCHES:
                target = operands.split(",")[-1].strip()
                if target == "_" + BY_POINTER:
                    yield index, None
                elif target.startswith("_"):
                    yield index, target[1:]
            elif op == "jmp" and not self._switch(index):
                yield index, None

    def _switch(self, index):
        """Where the jmp of a switch can go: the jumps behind it, or the labels of its table of addresses."""
        if index + 1 == len(self.code):
            return []
        targets = {self.labels[n] for o, text in self.code if o == ".db" for n in re.findall(r"\d+\$", text)
                   if self.code[index + 1][0] == ".db"}
        behind = index + 1
        while behind < len(self.code) and self.code[behind][0] in JUMPS:
            targets.add(behind)
            behind += 1
        return sorted(targets)

    def ends_at(self, index):
        """Does nothing run on from here?"""
        return self.code[index][0] in RETURNS | JUMPS | {"jmp", ".db"}

    def successors(self, index):
        op, operands = self.code[index]
        if op == "jmp":
            return self._switch(index)
        following = [] if self.ends_at(index) or index + 1 == len(self.code) else [index + 1]
        if op in JUMPS | BRANCHES:
            target = operands.split(",")[-1].strip()
            if target in self.labels:
                following.append(self.labels[target])
            elif target.endswith("$"):
                raise ValueError(f"{self.path}: {self.name}: no label {target}")
        # SDCC's other indirect call, lcall to a local label: the callee's address is pushed there, its ret comes back
        return following


class Source:
    """One .asm file."""

    def __init__(self, path):
        self.path = path
        self.functions = []
        self.exported = set()
        self.overlaid = []          # variables in the overlay area
        self.tables = set()         # names in tables of constants
        self._immediate = set()     # names whose address code works with
        self.data = set()
        self._parse(Path(path).read_text(errors="replace"))

    def _parse(self, text):
        area, current = "", None
        for line in text.splitlines():
            line = line.split(";")[0].strip()
            label = LABEL.match(line)
            if label:
                name, line = label.group(1), line[label.end():].strip()
                if name.endswith("$"):
                    if current:
                        current.labels[name] = len(current.code)
                elif area in ("CSEG", "HOME") and name.startswith("_") and name != "__interrupt_vect":
                    if current and current.code and not current.ends_at(-1):
                        current.code.append(("ljmp", name))  # runs on
                    current = Function(name[1:], self.path)
                    self.functions.append(current)
                else:
                    self.data.add(name[1:])
                    if area == "OSEG":
                        self.overlaid.append(name[1:])
            op, _, operands = line.replace("\t", " ").partition(" ")
            op, operands = op.lower(), operands.strip()
            if op == ".area":
                area, current = operands.split()[0], None
            elif op == ".globl":
                self.exported.add(operands[1:])
            elif op in (".byte", ".db", ".word", ".dw"):
                if current:
                    current.code.append((".db", operands))
                else:
                    self.tables |= {n[1:] for n in re.findall(r"\b_\w+", operands)}
            elif current and op and not op.startswith(".") and not operands.startswith("="):
                current.code.append((op, operands))
                if op == "mov":
                    self._immediate |= {n[1:] for n in re.findall(r"#\(?(_\w+)", operands)}

    def addresses_taken(self):
        """Names of functions that tables or code have the address of; of other files' data, too, from tables."""
        return (self.tables | self._immediate) - self.data


class Program:
    def __init__(self, paths, image=None):
        self.image = image
        self.sources = {path: Source(path) for path in paths}
        self.functions = [f for source in self.sources.values() for f in source.functions]
        self._own = {(f.path, f.name): f for f in self.functions}
        self._exported = {f.name: f for f in self.functions if f.name in self.sources[f.path].exported}
        self._library = {}
        self.data = {name for source in self.sources.values() for name in source.data}
        self.handlers = {f for source in self.sources.values() for f in self._functions_taken(source)}

    def _functions_taken(self, source):
        """What a call through a pointer may reach: every function whose address some file takes."""
        for name in source.addresses_taken() - self.data:
            function = self.resolve(source.path, name)
            if function and function.code and function.code[0][0] != ".db":
                yield function
            elif not function and not self.image and name in source.tables:
                yield Function(name, None)  # of a file that is not here, or data

    def resolve(self, path, name):
        """The function that a file means by a name: its own, another file's, the library's; None: not known."""
        function = self._own.get((path, name)) or self._exported.get(name) or self._library.get(name)
        if not function and self.image and "_" + name in self.image.code:
            function = self._library[name] = self.image.decode("_" + name)
        return function

    def callees(self, function):
        """(index, Function or None, name) of each call."""
        for index, name in function.calls():
            if name is not None:
                yield index, self.resolve(function.path, name), name
            for handler in self.handlers if name is None else ():
                yield index, handler, handler.name

    def reached_from(self, roots):
        """-> {function: by whom}: everything that runs when the roots do."""
        found, work = {root: None for root in roots}, list(roots)
        while work:
            function = work.pop()
            for _, callee, _ in self.callees(function):
                if callee and callee not in found:
                    found[callee] = function
                    work.append(callee)
        return found


# ---- the linked image ------------------------------------------------------------------------------------------

# Instruction lengths, one row for each high nibble: MCS-51 instruction set.
LENGTHS = [int(n) for n in ("1231121111111111" "3231121111111111" "3211221111111111" "3211221111111111"
                            "2223221111111111" "2223221111111111" "2223221111111111" "2221232222222222"
                            "2221132222222222" "3221221111111111" "2221112222222222" "2221333333333333"
                            "2221121111111111" "2221131122222222" "1211121111111111" "1211121111111111")]
BRANCH_CODES = {0x10: "jbc", 0x20: "jb", 0x30: "jnb", 0x40: "jc", 0x50: "jnc", 0x60: "jz", 0x70: "jnz", 0xD5: "djnz",
                **{0xB4 + n: "cjne" for n in range(12)}, **{0xD8 + n: "djnz" for n in range(8)}}
OTHER_CODES = {0x22: "ret", 0x32: "reti", 0x73: "jmp", 0xC0: "push", 0xD0: "pop"}
SP = 0x81
# Instructions that write their direct operand, by where it stands.
WRITES_DIRECT = {2: {0x85}, 1: {0x05, 0x15, 0x42, 0x43, 0x52, 0x53, 0x62, 0x63, 0x75, 0x86, 0x87, 0xC5, 0xF5,
                                *range(0x88, 0x90)}}


class Image:
    """IMAGE.ihx with its .map, .mem and .lk."""

    def __init__(self, ihx):
        self.ihx = Path(ihx)
        self.octets = {}
        for line in self.ihx.read_text().split():
            record = bytes.fromhex(line[1:])
            if record[3] == 0:
                at = record[1] << 8 | record[2]
                self.octets.update(enumerate(record[4:4 + record[0]], at))
        text = self.ihx.with_suffix(".map").read_text()
        self.code = {name: int(at, 16) for at, name in re.findall(r"^C:\s+([0-9A-F]{8})\s+(_\w+)", text, re.M)}
        self.names = {at: name for name, at in self.code.items()}
        self.sizes = {name: int(n, 16) for n, name in re.findall(r"^C:\s+([0-9A-F]{8})\s+l_(\w+)", text, re.M)}
        self.folder = self.ihx.with_suffix("")  # of the .asm files
        self.parts = re.findall(rf"^\S*\b{self.folder.name}/(\S+)\.rel$", self.ihx.with_suffix(".lk").read_text(), re.M)
        self.members = re.findall(r"\[ (\w+)\.rel \]", text)
        stack, self.stack_room = re.search(r"Stack starts at: 0x(\w+) .* with (\d+) bytes",
                                           self.ihx.with_suffix(".mem").read_text()).groups()
        self.stack_start, self.stack_room = int(stack, 16), int(self.stack_room)

    def has(self, asm):
        """Was this file linked? Of a library only what is called for is."""
        return str(asm.relative_to(self.folder).with_suffix("")) in self.parts or asm.stem in self.members

    def target(self, at):
        """Name of what the instruction at this address jumps to; None where it is no such jump."""
        if self.octets.get(at) != 0x02:
            return None
        return self.names.get(self.octets[at + 1] << 8 | self.octets[at + 2])

    def _operation(self, at):
        """-> (mnemonic, operands, length); a target is its function's name, or its address and $"""
        op = self.octets[at]
        length = LENGTHS[op]
        raw = [self.octets[at + i] for i in range(length)]
        if op in (0x02, 0x12):
            name, target = "ljmp" if op == 0x02 else "lcall", raw[1] << 8 | raw[2]
        elif op & 0x1F in (0x01, 0x11):
            name, target = "ajmp" if op & 0x1F == 0x01 else "acall", (at + 2) & 0xF800 | (op & 0xE0) << 3 | raw[1]
        elif op == 0x80 or op in BRANCH_CODES:
            name = "sjmp" if op == 0x80 else BRANCH_CODES[op]
            target = at + length + (raw[-1] ^ 0x80) - 0x80
        else:
            moves_sp = any(op in codes and raw[place] == SP for place, codes in WRITES_DIRECT.items())
            return OTHER_CODES.get(op, "moves sp" if moves_sp else "other"), "", length
        return name, self.names.get(target, f"{target:04X}$"), length

    def returns(self, at):
        """Addresses of each ret and reti that code from this address on may end with."""
        found, work = set(), [at]
        while work:
            at = work.pop()
            if at in found:
                continue
            found.add(at)
            op, operands, length = self._operation(at)
            if op == "jmp":
                raise ValueError(f"{self.ihx}: where the jump at {at:04X} goes cannot be told")
            if op not in RETURNS | JUMPS:
                work.append(at + length)
            if op in JUMPS | BRANCHES:
                work.append(int(operands[:-1], 16) if operands.endswith("$") else self.code[operands])
        return sorted(at for at in found if self._operation(at)[0] in RETURNS)

    def decode(self, name):
        """A routine of the library, by following it from its first instruction."""
        found, work = {}, [self.code[name]]
        while work:
            at = work.pop()
            if at in found:
                continue
            if at != self.code[name] and at in self.names:
                found[at] = ("ljmp", self.names[at], 0)  # runs on into another
                continue
            op, operands, length = found[at] = self._operation(at)
            if op not in RETURNS | JUMPS | {"jmp"}:
                work.append(at + length)
            if op in JUMPS | BRANCHES and operands.endswith("$"):
                work.append(int(operands[:-1], 16))
        function = Function(name[1:], None)
        for index, at in enumerate(sorted(found)):
            function.labels[f"{at:04X}$"] = index
            function.code.append(found[at][:2])
        return function


def load(ihx):
    """-> Program of a linked image; its .asm files are in the folder of its name."""
    image = Image(ihx)
    paths = [str(path) for path in sorted(image.folder.rglob("*.asm")) if image.has(path)]
    if len(paths) < len(image.parts):
        raise FileNotFoundError(f"{image.folder}: not all of {', '.join(image.parts)}")
    return Program(paths, image)
