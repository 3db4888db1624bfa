#!/usr/bin/env python3
"""fieldling-demo, what `make run` shows: the whole way to data exchange, both directions changing, honest exit status."""
import os
import pty
import re
import signal
import subprocess
import sys

from station import PATIENCE, expect, run_tests

PROGRAM = os.path.join(os.environ.get("FIELDLING_BIN", "build/posix"), "fieldling-demo")


def test_a_short_run_shows_everything_and_ends_with_a_summary():
    result = subprocess.run([PROGRAM, "--seconds", "5"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                            timeout=6 * PATIENCE, check=False)
    expect("exit status", result.returncode, 0)
    expect("standard error", result.stderr, "")
    for word in ("FDL_STATUS", "Slave_Diag.req", "Slave_Diag.res", "Set_Prm.req", "Chk_Cfg.req", "Data_Exchange.req",
                 "Data_Exchange.res", "DATA_EXCH", "Virtual time"):
        expect(f"{word} is shown", word in result.stdout, True)
    with open("README.md", encoding="utf-8") as readme:
        shown = [line for line in readme.read().splitlines() if re.match(r" +0\.\d{6} (->|<-) ", line)]
    expect("telegrams in README.md", [line for line in shown if line not in result.stdout], [])
    expect("README.md shows some", len(shown) >= 4, True)
    lines = re.findall(r"DATA_EXCH +outputs (\w\w \w\w) -> +<- (\d+) degrees.* exchanges (\d+) +T_SDR 11\.0 T_bit +errors 0",
                       result.stdout)
    expect("lines", len(lines) >= 4, True)
    expect("outputs change", len({line[0] for line in lines}) > 2, True)
    expect("inputs change", len({line[1] for line in lines}) > 2, True)
    expect("exchanges grow", [int(line[2]) for line in lines], sorted({int(line[2]) for line in lines}))
    # 34 degrees are more than the 33 it was parameterised with: diagnosis in the middle of the exchange
    expect("diagnosis is read", "3C 08 0C 00 02 12 34 02 01" in result.stdout, True)
    summary = result.stdout.splitlines()[-1]
    expect("summary", re.match(r"ok: \d+ exchanges in 5\.0 s, T_SDR 11\.0 \.\. 11\.0 bit times, 0 line errors", summary)
           is not None, True)


def test_ctrl_c_on_a_terminal_ends_with_the_summary_and_status_0():
    process, terminal = pty.fork()
    if process == 0:
        os.execv(PROGRAM, [PROGRAM])
    said = b""
    while b"DATA_EXCH" not in said or b"judge: no rule of the line broken" not in said:
        said += os.read(terminal, 4096)
    os.write(terminal, b"\x03")
    try:
        while True:
            said += os.read(terminal, 4096)
    except OSError:  # the terminal has no user any more
        pass
    expect("wait status", os.waitpid(process, 0)[1], 0)
    expect("summary", b"\nok: " in said[said.rindex(b"DATA_EXCH"):], True)
    os.close(terminal)


def test_without_data_exchange_the_exit_status_is_not_0():
    with subprocess.Popen([PROGRAM, "--baud", "9600"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          text=True) as process:
        process.stdout.readline()  # a quarter of a second before the first Data_Exchange at this rate
        process.send_signal(signal.SIGINT)
        said = process.stdout.read()
        expect("exit status", process.wait(PATIENCE), 1)
        expect("says so", "FAILED" in said and "data exchange was not reached" in said, True)


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
