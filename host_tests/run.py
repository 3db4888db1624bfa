#!/usr/bin/env python3
"""Run tests and count them.

usage: run.py [--asan] TEST[=SECONDS] ...

A TEST is a Unity program or a script (.py, .sh); each must print Unity's summary line
"N Tests M Failures K Ignored" and exit with 0 when M is 0. Crash, time-out and a missing summary count as
one failure. Tests run with FIELDLING_BIN=build/posix; those after --asan with FIELDLING_BIN=build/asan.
The last line is "N passed, N failed", with ", N skipped" when tests were ignored.
"""
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

DEFAULT_SECONDS = 120
JOBS = 2
SUMMARY = re.compile(r"^(\d+) Tests (\d+) Failures (\d+) Ignored", re.M)
IGNORED = re.compile(r"^.*?:IGNORE(?::\s*(.*))?$", re.M)


def command(path):
    if path.endswith(".py"):
        return [sys.executable, path]
    if path.endswith(".sh"):
        return ["sh", path]
    return [path]


def run_one(test):
    """-> (name, passed, failed, skipped, seconds, why, output)"""
    path, limit, bin_dir = test
    name = path + (" [asan]" if bin_dir == "build/asan" and not path.startswith("build/") else "")
    env = dict(os.environ, FIELDLING_BIN=bin_dir, ASAN_OPTIONS="detect_leaks=0:abort_on_error=0",
               UBSAN_OPTIONS="print_stacktrace=1", PYTHONDONTWRITEBYTECODE="1")
    start = time.monotonic()
    # Own process group: after a time-out nothing that the test started stays behind.
    try:
        process = subprocess.Popen(command(path), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, env=env, start_new_session=True)
    except OSError as error:
        return name, 0, 1, 0, 0.0, str(error), ""
    why = ""
    try:
        output, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        output, _ = process.communicate()
        why = f"no end after {limit} s"
    output = output.decode(errors="replace")
    seconds = time.monotonic() - start

    summaries = SUMMARY.findall(output)
    tests = sum(int(s[0]) for s in summaries)
    failed = sum(int(s[1]) for s in summaries)
    skipped = sum(int(s[2]) for s in summaries)
    passed = tests - failed - skipped
    if not why and not summaries:
        why = f"no summary line, exit status {process.returncode}"
    elif not why and tests == 0:
        why = "ran no test"
    elif not why and process.returncode != 0 and failed == 0:
        why = f"exit status {process.returncode} after a summary without failures"
    if why:
        failed += 1
    return name, passed, failed, skipped, seconds, why, output


def main(arguments):
    tests, bin_dir = [], "build/posix"
    for argument in arguments:
        if argument == "--asan":
            bin_dir = "build/asan"
            continue
        path, _, seconds = argument.partition("=")
        own_dir = "build/asan" if path.startswith("build/asan/") else bin_dir
        tests.append((path, int(seconds or DEFAULT_SECONDS), own_dir))

    passed = failed = skipped = 0
    reasons = []
    with ThreadPoolExecutor(JOBS) as pool:
        for name, ok, bad, ignored, seconds, why, output in pool.map(run_one, tests):
            passed, failed, skipped = passed + ok, failed + bad, skipped + ignored
            verdict = "FAIL" if bad else "ok"
            counts = f"{ok} passed" + (f", {bad} failed" if bad else "") + (f", {ignored} skipped" if ignored else "")
            print(f"{verdict:4} {seconds:7.2f} s  {name}: {counts}" + (f": {why}" if why else ""), flush=True)
            reasons += [f"skip {name}: {reason or 'no reason given'}" for reason in IGNORED.findall(output)]
            if bad:
                lines = [line for line in output.splitlines() if line.strip() and not line.endswith(":PASS")]
                print("".join(f"     | {line}\n" for line in lines[-200:]), end="", flush=True)
    for reason in reasons:
        print(reason)
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
