#!/usr/bin/env python3
"""The module tests, image by image, on the simulated 8051 (host_tests/s51_units.mk builds them)."""
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

IMAGES = Path("build/s51_units/images")
SECONDS = 180  # of the host for one image; it needs a few
PCON = "0x87"  # written once, at the end


def run(image):
    """-> what the image said"""
    with tempfile.TemporaryDirectory(prefix="fieldling-") as folder:
        said = Path(folder) / "said"
        command = ["s51", "-t", "52", "-X", "12M", "-b", "-P", "-S", f"in=/dev/null,out={said}", str(image)]
        try:
            # start-up writes PCON, too: the second run ends with the tests
            subprocess.run(command, input=f"break sfr w {PCON}\nrun\nrun\nkill\n", text=True, errors="replace",
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            pass
        return said.read_text(errors="replace") if said.exists() else ""


def main():
    images = [Path(line) for line in IMAGES.read_text(encoding="ascii").split()]
    tests = failures = ignored = 0
    with ThreadPoolExecutor(2) as pool:
        for image, said in zip(images, pool.map(run, images)):
            summary = re.search(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", said, re.M)
            if not summary:
                print(f"{image.stem}:FAIL: did not come to its end\n{said[-400:]}")
                tests, failures = tests + 1, failures + 1
                continue
            counts = [int(n) for n in summary.groups()]
            print(f"{image.stem}: {counts[0]} tests")
            print("".join(line + "\n" for line in said.splitlines() if ":FAIL" in line), end="")
            tests, failures, ignored = tests + counts[0], failures + counts[1], ignored + counts[2]
    if not images:
        print("no images: make boards")
    print("-----------------------")
    print(f"{tests} Tests {failures} Failures {ignored} Ignored")
    return 1 if failures or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
