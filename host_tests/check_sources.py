#!/usr/bin/env python3
"""House rules that can be read off the source text.

usage: check_sources.py FILE ...

  if      protocol code has no #if inside a function: leave out a file or a table row instead
  down    #include points down only: phy_uart < fdl < ddlm and modbus, hdlc beside them; protocol folders know
          neither boards nor sim nor a port's own headers; the simulation shares no code with the firmware
  path    no absolute path of a developer's machine
  heap    protocol code allocates no memory
  sleep   unit tests do not wait in host time
  bool    a struct in internal RAM (HOT) has no bool member: SDCC 4.2 forgets to store a comparison into it
"""
import re
import sys
from pathlib import Path

# Folder -> folders below it, whose headers it may include (besides its own and firmware/*.h).
BELOW = {
    "phy_uart": {"hal"},
    "fdl": {"hal", "phy_uart"},
    "ddlm": {"hal", "phy_uart", "fdl"},
    "modbus": {"hal"},
    "hdlc": {"hal"},
}
MACHINE_PATH = re.compile(r"""(?:^|[\s"'=:(<`])(/(?:work|root|home|tmp|opt|mnt|Users)/[^\s"'`]*)""")
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')
# The port in virtual time is the simulation's way to a station; everything else of the firmware is not its business.
SIM_MUST_NOT = re.compile(r"(firmware/)?(fdl|ddlm|modbus|hdlc|phy_uart|hal/(?!posix/))/|(firmware/)?(bytes|crc16|config)\.h")
CONDITIONAL = re.compile(r"^\s*#\s*(if|ifdef|ifndef|elif|else)\b")
HEAP = re.compile(r"\b(malloc|calloc|realloc|free|alloca)\s*\(")
SLEEP = re.compile(r"\b(sleep|usleep|nanosleep|clock_nanosleep)\s*\(")


def layer_of(path):
    """firmware/fdl/x.c -> fdl; None outside the protocol folders."""
    parts = Path(path).parts
    for i, part in enumerate(parts[:-1]):
        if part == "firmware" and parts[i + 1] in BELOW:
            return parts[i + 1]
    return None


def include_problem(path, name):
    layer, parts = layer_of(path), Path(path).parts
    folder = name.split("/")[0] if "/" in name else None
    if "sim" in parts[:-1] and SIM_MUST_NOT.match(name):
        return f"the simulation includes {name} of the firmware"
    if layer and folder and folder != layer and folder not in BELOW[layer]:
        return f"{layer} includes {name}, which is not below it"
    if layer and folder == "hal" and name not in ("hal/hal.h", "hal/hal_8273.h"):
        return f"{layer} includes {name}: of the port, only hal/hal.h"
    if layer and ".." in name:
        return f"{layer} includes {name}: write the folder's name"
    return None


def check(path):
    text = Path(path).read_text(errors="replace")
    layer, in_function = layer_of(path), False
    unit_test = re.search(r"host_tests/(bad_samples/)?test_\w+\.c$", str(path))
    for number, line in enumerate(text.splitlines(), 1):
        where = f"{path}:{number}: "
        for match in MACHINE_PATH.finditer(line):
            yield where + f"absolute path {match.group(1)}"
        if not str(path).endswith((".c", ".h")):
            continue
        if line.startswith("{"):
            in_function = True
        elif line.startswith("}"):
            in_function = False
        if layer and in_function and CONDITIONAL.match(line):
            yield where + "conditional compilation inside a function"
        include = INCLUDE.match(line)
        problem = include and include_problem(path, include.group(1))
        if problem:
            yield where + problem
        if layer and HEAP.search(line):
            yield where + "memory is allocated"
        if unit_test and SLEEP.search(line):
            yield where + "a unit test waits in host time"


HOT_STRUCT = re.compile(r"\bHOT\s+(?:volatile\s+)?struct\s+(\w*)\s*(?:\{([^}]*)\})?")


def hot_bools(paths):
    """The struct may be declared in one file and made HOT in another."""
    texts = {path: Path(path).read_text(errors="replace") for path in paths if str(path).endswith((".c", ".h"))}
    hot = {found.group(1) for text in texts.values() for found in HOT_STRUCT.finditer(text)} - {""}
    for path, text in texts.items():
        bodies = [found for found in HOT_STRUCT.finditer(text) if found.group(2)]
        bodies += [found for found in re.finditer(r"\bstruct\s+(\w+)\s*\{([^}]*)\}", text) if found.group(1) in hot]
        for found in bodies:
            if re.search(r"^\s*(?:volatile\s+)?bool\b", found.group(2), re.M):
                line = text.count("\n", 0, found.start()) + 1
                yield f"{path}:{line}: bool in a HOT struct"


def main(paths):
    problems = [p for path in paths for p in check(path)] + list(hot_bools(paths))
    print("\n".join(problems) if problems else f"sources: {len(paths)} files follow the house rules")
    return 1 if problems or not paths else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
