#!/usr/bin/env python3
"""fieldling-dp from the shell: arguments, the link, signals, standard streams that go away."""
import os
import signal
import subprocess
import sys
import tempfile

from raw_master import STATUS, RawMaster
from station import PATIENCE, Station, expect, run_tests

PROGRAM = os.path.join(os.environ.get("FIELDLING_BIN", "build/posix"), "fieldling-dp")


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=PATIENCE, check=False)


def unusable(*arguments):
    """-> the one line that says why."""
    result = run(*arguments)
    expect(f"{arguments}: exit status", result.returncode, 2)
    expect(f"{arguments}: standard output", result.stdout, "")
    expect(f"{arguments}: lines on standard error", result.stderr.count("\n"), 1)
    expect(f"{arguments}: who says it", result.stderr.startswith("fieldling-dp: "), True)
    return result.stderr


def test_unusable_arguments_give_one_line_and_status_2():
    with tempfile.TemporaryDirectory() as folder:
        pty = ["--line", f"pty:{folder}/line"]
        expect("names --line", "--line" in unusable(), True)
        for wrong in ([], ["--line"], ["--line", ""], ["--line="], ["--line", "pty:"], ["--line", "pty:" + "x" * 5000],
                      ["--line", f"{folder}/nothing"], ["--line", folder], ["--line", "/dev/null"],
                      ["--line", f"pty:{folder}"], ["--line", f"pty:{folder}/no/folder"]):
            unusable("--address", "8", *wrong)
        for value in ("127", "128", "-1", "", "x", "8x", " 8", "0x", "1e1", "99999999999999999999"):
            expect("names the value", f"--address {value}:" in unusable(*pty, "--address", value), True)
        for value in ("0", "-9600", "19201", "fast", "", "9600.0"):
            expect("names the value", f"--baud {value}:" in unusable(*pty, "--baud", value), True)
        for more in (["--address"], ["--baud"], ["--nv"], ["--nv", ""], ["--nv", folder], ["--nv", f"{folder}/no/nv"],
                     ["--speed", "1"], ["extra"], ["-a", "8"], ["--"], ["--addres", "8"], ["--address=8", "--x"]):
            unusable(*pty, *more)
        expect("nothing is left behind", os.listdir(folder), [])


def test_a_file_of_something_else_is_no_nv_memory():
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/letter", "w", encoding="ascii") as file:
            file.write("Dear Sir or Madam, \n")
        unusable("--line", f"pty:{folder}/line", "--nv", f"{folder}/letter")
        with open(f"{folder}/letter", encoding="ascii") as file:
            expect("letter", file.read(), "Dear Sir or Madam, \n")


def test_help_says_every_option_and_status_0():
    result = run("--line", "pty:/nonexistent/x", "--help")
    expect("exit status", result.returncode, 0)
    expect("standard error", result.stderr, "")
    for word in ("--line", "--address", "--baud", "--nv", "--help", "status", "trace", "quit", "SIGTERM"):
        expect(f"{word} is there", word in result.stdout, True)


def test_options_may_be_written_with_an_equals_sign():
    with Station("fieldling-dp", "--address=8", "--baud=500000") as station:
        status = station.ask("status")
        expect("address", status["address"], "8")
        expect("baud", status["baud"], "500000")


def test_the_link_leads_to_a_terminal_and_goes_with_the_station():
    for end in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, "quit"):
        with Station("fieldling-dp", "--address", "8") as station:
            expect("a pts", os.readlink(station.pty).startswith("/dev/pts/"), True)
            if end == "quit":
                expect("answer", station.ask("quit"), {"quit": "ok"})
            else:
                station.process.send_signal(end)
            expect(f"exit status after {end}", station.process.wait(PATIENCE), 0)
            expect("the link", os.path.lexists(station.pty), False)


class Plain:
    """The program without Station: its streams, its line at path, ready when this returns."""

    def __init__(self, path):
        self.process = subprocess.Popen([PROGRAM, "--line", "pty:" + path, "--address", "8"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        self.process.stdin.write("out\n")
        self.process.stdin.flush()
        expect("first answer", self.process.stdout.readline(), "out=0000\n")

    def __enter__(self):
        return self.process

    def __exit__(self, *_):
        self.process.terminate()
        expect("exit status", self.process.wait(PATIENCE), 0)
        self.process.stdin.close()
        self.process.stdout.close()


def test_the_link_of_a_killed_station_is_replaced():
    with Station("fieldling-dp", "--address", "8") as first:
        first.process.kill()
        first.process.wait(PATIENCE)
        expect("is left", os.path.islink(first.pty), True)
        with Plain(first.pty), RawMaster(first.pty) as master:
            master.ask(*STATUS)
        expect("the link", os.path.lexists(first.pty), False)


def test_a_station_removes_its_own_link_only():
    with Station("fieldling-dp", "--address", "8") as station:
        os.unlink(station.pty)
        os.symlink("/dev/pts/ptmx", station.pty)
        station.process.terminate()
        expect("exit status", station.process.wait(PATIENCE), 0)
        expect("the other's link", os.readlink(station.pty), "/dev/pts/ptmx")


def test_what_is_not_a_stale_link_is_left_alone():
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/line"
        with open(path, "w", encoding="ascii") as file:
            file.write("mine")
        unusable("--line", "pty:" + path)
        with open(path, encoding="ascii") as file:
            expect("the file", file.read(), "mine")
        os.symlink("line", f"{folder}/link")
        unusable("--line", f"pty:{folder}/link")
        expect("the link", os.readlink(f"{folder}/link"), "line")


def test_the_end_of_the_input_does_not_end_the_station():
    with Station("fieldling-dp", "--address", "8") as station:
        station.process.stdin.close()
        with RawMaster(station.pty) as master:
            for _ in range(20):
                master.ask(*STATUS)
        expect("still there", station.process.poll(), None)


def test_a_console_that_nobody_reads_does_not_hold_the_station_up():
    with tempfile.TemporaryDirectory() as folder, Plain(f"{folder}/line") as process:
        # 1 MB of trace into a pipe that is never read, then into one that is closed
        process.stdin.write("trace on\n")
        process.stdin.flush()
        with RawMaster(f"{folder}/line") as master:
            for _ in range(5000):
                master.ask(*STATUS)
            process.stdout.close()
            for _ in range(100):
                master.ask(*STATUS)
        expect("still there", process.poll(), None)


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
