#!/usr/bin/env python3
"""The static checks reject what they are for: each file of bad_samples/ says what must be found in it.

"expect: TEXT" must appear in the output of a check that fails; good.c must pass all of them.
FIELDLING_SDCC is the compiler with the options of the 8051 build (host_tests/static.mk).
"""
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from stack51 import measured_and_computed

HERE = Path(__file__).parent


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    return done.returncode != 0, done.stdout


def compiled(source, target):
    """-> SDCC's failed runs"""
    sdcc = shlex.split(os.environ["FIELDLING_SDCC"])
    if Path(source).name == "overlay.c":  # shows what --nooverlay is for
        sdcc.remove("--nooverlay")
    return [run(*sdcc, "-c", str(source), "-o", str(target))]


def check_object(sample, folder):
    """One file by itself."""
    checks = compiled(sample, folder / "sample.rel")
    if not checks[0][0]:
        checks.append(run(sys.executable, str(HERE / "check_contexts.py"), str(folder / "sample.asm")))
    return checks


def check_linked(sample, folder):
    """bad_samples/image/: an image, with a main() that does nothing where the sample has none.

    "doctor: OLD -> NEW" changes what the compiler made, "budget: FIGURES" is the image's row in a budget, "measure: N" runs
    N instructions: the stack is as deep then as its calls allow."""
    text, parts = sample.read_text(), folder / "x"
    parts.mkdir()
    (folder / "sample.c").write_text(text)
    (folder / "rest.c").write_text("void main(void)\n{\n    for (;;) {\n    }\n}\n")
    names = ["sample"] if "void main(void)" in text else ["sample", "rest"]
    checks = [done for name in names for done in compiled(folder / f"{name}.c", parts / f"{name}.rel")]
    doctor = re.search(r"doctor: (.+) -> (.+)", text)
    for name in names if doctor else ():
        asm = parts / f"{name}.asm"
        asm.write_text(asm.read_text().replace(*doctor.groups()))
        checks.append(run("sdas8051", "-plosgff", str(parts / f"{name}.rel"), str(asm)))
    ihx, rels = str(folder / "x.ihx"), [str(parts / f"{name}.rel") for name in names]
    checks.append(run("sdcc", "-mmcs51", "--model-large", "--iram-size", "256", *rels, "-o", ihx))
    checks.append(run(sys.executable, str(HERE / "check_image.py"), "--root", str(folder), ihx))
    budget = re.search(r"budget: ([\d ]+)", text)
    if budget:
        (folder / "budget.txt").write_text("x " + budget[1])
        checks.append(run(sys.executable, str(HERE / "mcs51_size.py"), "--budget", str(folder / "budget.txt"), ihx))
    measure = re.search(r"measure: (\d+)", text)
    if measure:
        measured, computed = measured_and_computed(ihx, highest_sp(ihx, measure[1]))
        checks.append((measured != computed, f"stack: {measured} octets measured, {computed} computed\n"))
    return checks


def highest_sp(ihx, instructions):
    command = ["s51", "-t", "52", "-b", "-P", ihx]
    said = subprocess.run(command, input=f"step {instructions}\nstate\nkill\n", stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True, timeout=60).stdout
    return int(re.search(r"Max value of stack pointer= (0x\w+)", said)[1], 16)


def findings(sample, folder):
    """Output of the checks that fail for the sample."""
    checks = [run(sys.executable, str(HERE / "check_sources.py"), str(sample))]
    if sample.parent.name == "image":
        checks += check_linked(sample, folder)
    elif not re.search(r"^#include (\"(ddlm|hal/posix)|<unistd)", sample.read_text(), re.M):
        checks += check_object(sample, folder)
    return "".join(output for failed, output in checks if failed)


def judge(sample):
    """-> (sample, is it good?, what was found)"""
    with tempfile.TemporaryDirectory() as folder:
        found = findings(sample, Path(folder))
    expected = re.search(r"expect: (.+?)(?: \*/)?$", sample.read_text(), re.M)
    return sample, expected.group(1) in found if expected else found == "", found


def main():
    failures = 0
    samples = sorted((HERE / "bad_samples").rglob("*.c"))
    with ThreadPoolExecutor(2) as pool:
        for sample, good, found in pool.map(judge, samples):
            print(f"{sample}:1:{sample.stem}:" + ("PASS" if good else "FAIL: found " + (found or "nothing")))
            failures += not good
    print(f"\n{len(samples)} Tests {failures} Failures 0 Ignored")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
