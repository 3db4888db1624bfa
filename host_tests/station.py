"""A host station as a test sees it: a process with a console, its line a pseudo terminal in a fresh folder."""
import os
import queue
import re
import shutil
import subprocess
import tempfile
import threading
import time

PATIENCE = 10.0  # seconds for anything that should take milliseconds; the machine may be busy


class Station:
    """with Station("fieldling-dp", "--address", "8") as s: s.pty is the line, s.ask("status")["state"] ..."""

    def __init__(self, program, *arguments):
        self.folder = tempfile.mkdtemp(prefix="fieldling-")
        self.pty = os.path.join(self.folder, "line")
        self._start([os.path.join(os.environ.get("FIELDLING_BIN", "build/posix"), program), "--line", "pty:" + self.pty,
                     *arguments])
        self.wait(lambda: os.path.islink(self.pty), "the line")

    def _start(self, command):
        """The console is the process's standard input and output."""
        self.traces = []  # trace lines in the order they came
        self._answers = queue.Queue()
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
        threading.Thread(target=self._read, daemon=True).start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        try:
            self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _read(self):
        for line in self.process.stdout:
            if re.match(r"trace=(rx|tx|lost) ", line):
                self.traces.append(line.rstrip("\n"))
            else:
                self._answers.put(line.rstrip("\n"))

    def ask(self, line):
        """One console line -> its answer as {key: value}."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        try:
            answer = self._answers.get(timeout=PATIENCE)
        except queue.Empty:
            raise AssertionError(f"no answer to {line!r}, exit status {self.process.poll()}") from None
        return dict(pair.split("=", 1) for pair in answer.split())

    def wait(self, done, what):
        """Until done() is true."""
        end = time.monotonic() + PATIENCE
        while not done():
            if self.process.poll() is not None:
                raise AssertionError(f"the station ended with status {self.process.returncode} before {what} was there")
            if time.monotonic() > end:
                raise AssertionError(f"{what} did not come in {PATIENCE:.0f} s")
            time.sleep(0.001)


def run_tests(tests):
    """Run functions named test_*, print the way Unity does. -> exit status"""
    failures = ignored = 0
    for test in tests:
        where = f"{test.__code__.co_filename}:{test.__code__.co_firstlineno}:{test.__name__}:"
        try:
            test()
            print(where + "PASS", flush=True)
        except Skip as reason:
            ignored += 1
            print(f"{where}IGNORE: {reason}", flush=True)
        except Exception as error:  # whatever a foreign master throws is this test's failure, not the run's end
            failures += 1
            print(f"{where}FAIL: {type(error).__name__}: {error}", flush=True)
    print(f"\n{len(tests)} Tests {failures} Failures {ignored} Ignored")
    return 1 if failures else 0


class Skip(Exception):
    """This test cannot run here; the text says why."""


def expect(text, is_value, should_be):
    if is_value != should_be:
        raise AssertionError(f"{text}: expected {should_be!r}, was {is_value!r}")
