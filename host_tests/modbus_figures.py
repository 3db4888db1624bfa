#!/usr/bin/env python3
"""What the Modbus server costs, beside what its peers cost; each figure has a limit and is a test.

The request is "read 10 holding registers", the small server has functions 1-6, 15, 16 and RTU only, as in the peers'
measurement. Cortex-M0: arm-none-eabi-gcc -Os, instructions of all interrupts and the main loop for one request in
Unicorn, stack from entry. PC: gcc -O2, valgrind --tool=callgrind. 8051: SDCC --model-large without --stack-auto,
machine cycles in s51 from the end of t3.5 to hal_send().
"""
import os
import re
import subprocess
import sys
from pathlib import Path

from station import run_tests

BUILD = Path("build/modbus_figures")
SOURCES = ["firmware/crc16.c", *sorted(map(str, Path("firmware/modbus").glob("*.c")))]
CRC, CRC_MCS51 = "firmware/crc16_append.c", "firmware/hal/mcs51/crc16_append.c"
REQUEST = "host_tests/modbus_figures/request.c"
INCLUDES = ["-Ifirmware", "-Ihost_tests", "-I."]
RX_OCTETS = 8

# name: M0 library text, M0 instructions, M0 stack, x86-64 instructions, 8051 code and cycles, wrong of 61 vectors.
PEERS = [
    ("liblightmodbus", "1429", "3727", "160", "3431", "does not compile", "0"),
    ("nanoMODBUS 1.22", "2658", "3350", "672", "3099", "19838, does not fit", "11"),
    ("FreeMODBUS", "2304", "2475", "124", "1698", "7508 / 13185", "9"),
    ("agile_modbus", "3462", "1702", "492", "921", "38136", "19"),
    ("niwciu/MODBUS", "2654", "1182", "120", "953", "11802 / 16025", "9"),
    ("uC/Modbus", "2414", "4310", "120", "3582", "13485 / 36259", "11"),
    ("c-modbus-slave", "9152", "3635", "272", "2810", "41719", "1"),
]

# What the port and the main loop call; what they call in turn is counted with them, the port's empty services too.
ENTRIES = ("line_octet_isr", "line_silence_isr", "line_sent_isr", "mb_poll")

figures = {}


def sh(*command, **more):
    return subprocess.run([str(c) for c in command], check=True, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120, **more).stdout


def objects(folder, suffix, compiler, config, sources):
    folder.mkdir(parents=True, exist_ok=True)
    for source in sources:
        sh(*compiler, *INCLUDES, f'-DMB_CONFIG="modbus_figures/{config}.h"', "-c", source, "-o",
           folder / (Path(source).stem + suffix))
    return [folder / (Path(source).stem + suffix) for source in sources]


# ---- Cortex-M0 ---------------------------------------------------------------------------------------------------

ARM = ["arm-none-eabi-gcc", "-std=c99", "-mcpu=cortex-m0", "-mthumb", "-Os", "-ffunction-sections", "-fdata-sections",
       "-ffreestanding", "-DNDEBUG", "-DCRC16_ENTRIES=16", "-Ifirmware/hal/posix"]
ARM_MAIN = """#include "modbus_figures/request.h"
void figure_mark(uint8_t mark) { (void)mark; }
void *memset(void *p, int c, size_t n) { char *q = p; while (n--) *q++ = (char)c; return p; }
"""


def link_m0(config):
    folder = BUILD / f"m0_{config}"
    library = objects(folder, ".o", ARM, config, [*SOURCES, CRC])
    main = folder / "main.c"
    main.write_text(ARM_MAIN)
    own = objects(folder, ".o", ARM, config, [REQUEST, str(main)])
    elf = folder / "image.elf"
    archive = folder / "library.a"
    archive.unlink(missing_ok=True)
    sh("arm-none-eabi-ar", "rcs", archive, *library)
    keep = ("figure_open", "figure_request", "figure_ok", *ENTRIES)
    sh("arm-none-eabi-gcc", "-mcpu=cortex-m0", "-mthumb", "-nostartfiles", "-Wl,--gc-sections", "-Wl,-Ttext=0x10000",
       "-Wl,-Tdata=0x20000000", "-Wl,-e,figure_request", *[f"-Wl,-u,{name}" for name in keep], *own, archive, "-lgcc",
       f"-Wl,-Map={folder / 'map'}", "-o", elf)
    return elf


def library_text(elf):
    """Octets of code and constants of the linked image that come from the library."""
    total, in_discarded, section = 0, True, ""
    for line in (elf.parent / "map").read_text().splitlines():
        if "Linker script and memory map" in line:
            in_discarded = False
        if in_discarded:
            continue
        start = re.match(r" (\.(?:text|rodata)\S*)", line)
        if start:
            section = start.group(1)
        match = re.search(r"0x([0-9a-f]+)\s+0x([0-9a-f]+) .*library\.a\(", line)
        if match and section and (start or line.startswith("      ")):
            total += int(match.group(2), 16)
        if not line.startswith("      "):
            section = section if start else ""
    return total


class M0:
    STACK = 0x30000000

    def __init__(self, elf):
        from unicorn import UC_ARCH_ARM, UC_HOOK_CODE, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
        from unicorn import arm_const
        self.registers = arm_const
        rows = [line.split() for line in sh("arm-none-eabi-nm", "-S", elf).splitlines()]
        self.symbols = {row[-1]: int(row[0], 16) for row in rows}
        self.rig = [(int(row[0], 16), int(row[0], 16) + int(row[1], 16)) for row in rows
                    if len(row) == 4 and row[3].startswith("figure_")]
        self.uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(arm_const.UC_CPU_ARM_CORTEX_M0)
        for base in (0x10000, 0x20000000, self.STACK - 0x10000):
            self.uc.mem_map(base, 0x10000)
        for line in sh("arm-none-eabi-objdump", "-h", elf).splitlines():
            part = line.split()
            if len(part) == 7 and part[1].startswith((".text", ".rodata", ".data")) and int(part[2], 16):
                raw = elf.parent / "section"
                sh("arm-none-eabi-objcopy", "-O", "binary", "-j", part[1], elf, raw)
                self.uc.mem_write(int(part[3], 16), raw.read_bytes())
        self.uc.hook_add(UC_HOOK_CODE, self._step)

    def _step(self, uc, address, size, _):
        if not any(start <= address < end for start, end in self.rig):
            self.count += 1
        self.lowest = min(self.lowest, uc.reg_read(self.registers.UC_ARM_REG_SP))

    def call(self, name):
        self.count, self.lowest = 0, self.STACK
        self.uc.reg_write(self.registers.UC_ARM_REG_SP, self.STACK)
        self.uc.reg_write(self.registers.UC_ARM_REG_LR, 0x1FFF0 | 1)
        self.uc.emu_start(self.symbols[name] | 1, 0x1FFF0, count=1000000)
        return self.uc.reg_read(self.registers.UC_ARM_REG_R0)


def measure_m0():
    small, full = link_m0("mb_small"), link_m0("mb_full")
    figures["m0_text"], figures["m0_full_text"] = library_text(small), library_text(full)
    machine = M0(small)
    machine.call("figure_open")
    machine.call("figure_request")
    figures["m0_instructions"], figures["m0_stack"] = machine.count, M0.STACK - machine.lowest
    if machine.call("figure_ok") & 0xFF != 1:
        raise AssertionError("the Cortex-M0 gave a wrong answer")
    full_machine = M0(full)
    full_machine.call("figure_open")
    full_machine.call("figure_request")
    figures["m0_full_instructions"], figures["m0_full_stack"] = full_machine.count, M0.STACK - full_machine.lowest
    if full_machine.call("figure_ok") & 0xFF != 1:
        raise AssertionError("the Cortex-M0 gave a wrong answer")


# ---- PC ----------------------------------------------------------------------------------------------------------

def measure_pc():
    folder = BUILD / "pc"
    own = objects(folder, ".o", ["gcc", "-std=c99", "-O2", "-g", "-DNDEBUG", "-Ifirmware/hal/posix"], "mb_small",
                  [REQUEST, "host_tests/modbus_figures/main_pc.c"])
    library = objects(folder, ".o", ["gcc", "-std=c99", "-O2", "-g", "-DNDEBUG", "-Ifirmware/hal/posix"], "mb_small",
                      [*SOURCES, CRC])
    archive = folder / "library.a"
    archive.unlink(missing_ok=True)
    sh("ar", "rcs", archive, *library)
    sh("gcc", *own, archive, "-o", folder / "request")
    out = folder / "callgrind.out"
    sh("valgrind", "--tool=callgrind", f"--callgrind-out-file={out}",
       *[f"--toggle-collect={name}" for name in ENTRIES], folder / "request", "100")
    figures["pc_instructions"] = int(re.search(r"^summary: (\d+)", out.read_text(), re.M).group(1)) // 100


# ---- 8051 --------------------------------------------------------------------------------------------------------

SDCC = ["sdcc", "-mmcs51", "--model-large", "--std-c11", "--nooverlay", "-DNDEBUG", "-DCRC16_ENTRIES=512", "-Ifirmware/hal/blank",
        "--disable-warning", "110", "--disable-warning", "126"]


def measure_mcs51():
    folder = BUILD / "mcs51"
    library = objects(folder, ".rel", SDCC, "mb_small", [*SOURCES, CRC_MCS51])
    own = objects(folder, ".rel", SDCC, "mb_small", [REQUEST, "host_tests/modbus_figures/main_mcs51.c"])
    archive = folder / "library.lib"
    archive.unlink(missing_ok=True)
    sh("sdar", "-rc", archive, *library)
    image = folder / "image.ihx"
    sh(*SDCC, own[1], own[0], archive, "-o", image)
    memory = image.with_suffix(".mem").read_text()
    figures["mcs51_code"] = int(re.search(r"ROM/EPROM/FLASH\s+0x\w+\s+0x\w+\s+(\d+)", memory).group(1))
    # Marks come in a known order, and the last only after a right answer: without it the simulator runs into the
    # time limit. The times are taken from its own report at each stop, in clocks; a machine cycle is twelve.
    stops = 2 * RX_OCTETS + 4
    script = "break sfr w 0x90\n" + "run\n" * stops + "kill\n"
    log = subprocess.run(["s51", "-t", "52", "-X", "12M", "-b", "-P", str(image)], input=script, text=True, timeout=30,
                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False, errors="replace").stdout
    took = [int(clocks) // 12 for clocks in re.findall(r"Simulated (\d+) ticks", log)]
    if len(took) != stops:
        raise AssertionError(f"the 8051 stopped {len(took)} times, not {stops}")
    figures["mcs51_octet_cycles"] = max(took[1:2 * RX_OCTETS:2])
    figures["mcs51_cycles"] = took[2 * RX_OCTETS + 1]


# ---- tests ---------------------------------------------------------------------------------------------------------

def at_most(what, limit):
    if figures[what] > limit:
        raise AssertionError(f"{what} is {figures[what]}, the limit is {limit}")


def test_cortex_m0_text_of_the_small_server():
    at_most("m0_text", 1400)


def test_cortex_m0_instructions_for_a_request():
    at_most("m0_instructions", 1150)


def test_cortex_m0_stack():
    at_most("m0_stack", 120)


def test_cortex_m0_text_of_the_full_server():
    at_most("m0_full_text", 9100)


def test_x86_64_instructions_for_a_request():
    at_most("pc_instructions", 900)


def test_8051_code():
    at_most("mcs51_code", 7500)


def test_8051_cycles_from_t35_to_the_first_octet_of_the_answer():
    at_most("mcs51_cycles", 2000)


def table():
    f = figures
    head = ("", "M0 text", "M0 instr.", "M0 stack", "x86-64 instr.", "8051 code/cycles", "wrong of 61")
    own = ("Fieldling", f["m0_text"], f["m0_instructions"], f["m0_stack"], f["pc_instructions"],
           f"{f['mcs51_code']} / {f['mcs51_cycles']}", "")
    print("Modbus server, functions 1-6, 15, 16, RTU; one request 'read 10 holding registers':")
    for row in (head, own, *PEERS):
        print("  {:16} {:>8} {:>10} {:>9} {:>14} {:>20} {:>12}".format(*row))
    print(f"  8051: {f['mcs51_octet_cycles']} cycles at most for an octet received (11 bits last 528 cycles at 19200 bit/s "
          "and 11.0592 MHz)")
    print(f"  all functions, RTU and ASCII: M0 text {f['m0_full_text']}, {f['m0_full_instructions']} instructions, "
          f"{f['m0_full_stack']} stack")


def main():
    os.environ["LC_ALL"] = "C"
    measure_m0()
    measure_pc()
    measure_mcs51()
    if sys.argv[1:] == ["--table"]:
        table()
        return 0
    return run_tests([test for name, test in globals().items() if name.startswith("test_")])


if __name__ == "__main__":
    sys.exit(main())
