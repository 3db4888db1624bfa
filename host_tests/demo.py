#!/usr/bin/env python3
"""What `make run` shows, fieldling-master on a simulated segment: the whole way to data exchange, both directions changing,
honest exit status; and that such a segment is a line like any other."""
import fcntl
import json
import os
import pty
import re
import signal
import struct
import subprocess
import sys
import tempfile
import termios
from pathlib import Path

from station import PATIENCE, expect, run_tests

BIN = os.environ.get("FIELDLING_BIN", "build/posix")
MASTER = os.path.join(BIN, "fieldling-master")
DEMO = ["sh", "boards/posix/dp_demo.sh"]
GSD = "gsd/FLDL1234.GSD"


def run(arguments):
    return subprocess.run(arguments, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=6 * PATIENCE,
                          check=False)


def test_a_short_run_shows_everything_and_ends_with_a_summary():
    result = run([*DEMO, "--seconds", "5"])
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


def test_it_ends_after_10_s_and_the_readme_shows_its_lines():
    def form(text):  # exchanges, and so outputs, may differ by one
        return [re.sub(r"outputs \w\w \w\w|\d+ exchanges|exchanges \d+ *", "#", line) for line in text.splitlines()]
    result = run(DEMO)
    expect("exit status", result.returncode, 0)
    shown = [line for line in form(Path("README.md").read_text()) if re.match(r" +\d+\.\d s |ok: ", line)]
    expect("lines in README.md", [line for line in shown if line not in form(result.stdout)], [])
    expect("README.md shows some", len(shown) >= 3, True)


def test_ctrl_c_on_a_terminal_ends_with_the_summary_and_status_0():
    process, terminal = pty.fork()
    if process == 0:
        os.execvp(DEMO[0], DEMO)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
    said = b""
    while said.count(b"DATA_EXCH") < 5 or b"judge: no rule of the line broken" not in said:
        said += os.read(terminal, 4096)
    expect("Ctrl-C is a key: make gets no signal", bool(termios.tcgetattr(terminal)[3] & termios.ISIG), False)
    os.write(terminal, b"\x03")
    try:
        while True:
            said += os.read(terminal, 4096)
    except OSError:  # the terminal has no user any more
        pass
    expect("wait status", os.waitpid(process, 0)[1], 0)
    expect("summary", b"\nok: " in said[said.rindex(b"DATA_EXCH"):], True)
    os.close(terminal)
    text = said.decode()
    for pattern in (r"\n +8 DP-TEST01 +exchange +\d+ +0 +0 ", r"owner 2, groups 01, watchdog 200 ms on, sync enabled, freeze enabled",
                    r"allowed 11 \.\. 60", r"parity 0, gap 0, format 0, FCS 0, retries 0, lost 0; judge: no rule of the line broken"):
        expect(pattern, re.search(pattern, text) is not None, True)
    expect("it is drawn over itself", "\x1b[7F\x1b[J" in text, True)


def test_commands_and_quit_on_a_terminal():
    process, terminal = pty.fork()
    if process == 0:
        os.execvp(MASTER, [MASTER, "--line", "sim:8", "cyclic", "boards/posix/dp_demo.conf"])
    said = b""
    for until, typed in ((b"DATA_EXCH", b"out 8 A5 5A\n"), (b"outputs A5 5A ->", b"quit\n")):
        while until not in said:
            said += os.read(terminal, 4096)
        os.write(terminal, typed)
    try:
        while True:
            said += os.read(terminal, 4096)
    except OSError:
        pass
    expect("wait status", os.waitpid(process, 0)[1], 0)
    os.close(terminal)


def test_without_data_exchange_the_exit_status_is_not_0():
    with subprocess.Popen([*DEMO, "--rate", "9600"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          text=True) as process:
        process.stdout.readline()  # a quarter of a second before the first Data_Exchange at this rate
        process.send_signal(signal.SIGINT)
        said = process.stdout.read()
        expect("exit status", process.wait(PATIENCE), 1)
        expect("says so", "FAILED" in said and "data exchange was not reached" in said, True)


def test_class_2_on_a_simulated_segment():
    result = run([MASTER, "--line", "sim:5", "--json", "diag", "5"])
    expect("diagnosis", json.loads(result.stdout)["octets"], "02 05 00 FF 12 34")
    expect("live list", json.loads(run([MASTER, "--line", "sim:5", "--json", "live-list"]).stdout)["stations"], ["5 slave"])
    expect("an absent station", run([MASTER, "--line", "sim:", "diag", "5"]).returncode, 3)
    expect("a new address", run([MASTER, "--line", "sim:126", "set-address", "126", "17", "0x1234"]).returncode, 0)


def test_json_tells_what_the_segment_measured():
    result = run([MASTER, "--line", "sim:", "--slave", f"8={GSD}", "--seconds", "1", "--json", "cyclic"])
    slave, _, line = map(json.loads, result.stdout.splitlines())
    expect("exit status", result.returncode, 0)
    expect("state", (slave["state"], slave["lost"], slave["inputs"][:2] in ("1E", "1F")), ("exchange", 0, True))
    expect("line", line, {"t_sdr_min": "11.0", "t_sdr_max": "11.0", "line_errors": 0, "rules_broken": 0})


def test_a_master_of_somebody_else_fails():
    result = run([MASTER, "--line", "sim:8", "--slave", f"9={GSD}", "--seconds", "1", "cyclic"])
    expect("exit status", result.returncode, 1)
    expect("shown once, not at each try", result.stdout.count("10 09 02 49 54 16"), 1)
    expect("says so", "not reached" in result.stdout, True)


def test_the_record_has_the_segment_s_time():
    with tempfile.TemporaryDirectory() as folder:
        record = os.path.join(folder, "rec")
        run([*DEMO, "--seconds", "1", "--record", record])
        said = run([os.path.join(BIN, "fieldling-mon"), "--summary", record]).stdout
    expect("T_SDR", re.search(r"^ +8 .* 11\.00/ +11\.00/ +11\.00 ", said, re.M) is not None, True)
    expect("wrong", " 0 requests without T_SYN; 0 wrong" in said, True)


def test_unusable_segments_are_told_in_one_line():
    for arguments, text in ((["--line", "sim:127"], "0 to 126"), (["--line", "sim:8x"], "0 to 126"),
                            (["--line", "sim:", "--rate", "1000"], "has the rates 9600,")):
        result = run([MASTER, *arguments, "diag", "8"])
        expect(f"{arguments}", (result.returncode, text in result.stderr, result.stderr.count("\n")), (4, True, 1))


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
