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
from pathlib import Path

HERE = Path(__file__).parent


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    return done.returncode != 0, done.stdout


def findings(sample, folder):
    """Output of the checks that fail for the sample."""
    checks = [run(sys.executable, str(HERE / "check_sources.py"), str(sample))]
    text = sample.read_text()
    if not re.search(r"^#include (\"(ddlm|hal/posix)|<unistd)", text, re.M):
        # overlay.c shows what --nooverlay is for
        sdcc = shlex.split(os.environ["FIELDLING_SDCC"])
        if sample.name == "overlay.c":
            sdcc.remove("--nooverlay")
        # the rest of an image, for rules that need to see all of it
        (Path(folder) / "rest.c").write_text("void main(void)\n{\n    for (;;)\n        ;\n}\n")
        for source, name in ((str(sample), "sample"), (f"{folder}/rest.c", "rest")):
            checks.append(run(*sdcc, "-c", source, "-o", f"{folder}/{name}.rel"))
        if not checks[-1][0] and not checks[-2][0]:
            checks.append(run(sys.executable, str(HERE / "check_contexts.py"), "--sources", str(HERE / "bad_samples"),
                              f"{folder}/sample.asm", f"{folder}/rest.asm"))
    return "".join(output for failed, output in checks if failed)


def main():
    failures = 0
    samples = sorted((HERE / "bad_samples").rglob("*.c"))
    for sample in samples:
        with tempfile.TemporaryDirectory() as folder:
            found = findings(sample, folder)
        expected = re.search(r"expect: (.+?)(?: \*/)?$", sample.read_text(), re.M)
        good = expected.group(1) in found if expected else found == ""
        print(f"{sample}:1:{sample.stem}:" + ("PASS" if good else "FAIL: found " + (found or "nothing")))
        failures += not good
    print(f"\n{len(samples)} Tests {failures} Failures 0 Ignored")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
