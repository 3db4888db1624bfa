"""A board's image in QEMU as a test sees it: like a Station, its line is a pseudo terminal, its console answers."""
import queue
import re
import shutil
import tempfile
from typing import NamedTuple

from station import Skip, Station


class Board(NamedTuple):
    command: list  # QEMU, the machine
    suffix: str    # of the images
    load: str      # the options that load the image at {}
    exit_shift: int = 0  # how far QEMU's exit status holds that of the image's main() to the left


BOARDS = {
    "com86": Board(["qemu-system-i386", "-M", "pc", "-cpu", "486", "-m", "1", "-no-reboot",
                    "-device", "isa-debug-exit,iobase=0xf4,iosize=4"], "bin", "-drive if=pflash,format=raw,file={}",
                   exit_shift=1),
    "lm3s6965evb": Board(["qemu-system-arm", "-M", "lm3s6965evb", "-semihosting-config", "enable=on,target=native"],
                         "elf", "-kernel {}"),
    "rv32virt": Board(["qemu-system-riscv32", "-M", "virt", "-m", "16", "-bios", "none"], "elf",
                      "-kernel {} -device pci-serial,chardev=line,addr=1"),
}


def image_path(board, image):
    """Skips the test where the image could not be built: only RISC-V's tools are optional (setup.sh)."""
    path = f"build/{board}/{image}.{BOARDS[board].suffix}"
    if board == "rv32virt" and not all(map(shutil.which, ("riscv64-unknown-elf-gcc", BOARDS[board].command[0]))):
        raise Skip("no compiler or no simulator for RISC-V here")
    return path


def qemu(board, path, console, line, trace=(), events=None, more=()):
    """The command that runs the board's image at path; console and line are character devices with id=console and
    id=line. What COM86 writes into its flash is kept in the file at path."""
    return [*BOARDS[board].command, *BOARDS[board].load.format(path).split(), "-display", "none", "-nodefaults",
            "-monitor", "none", "-net", "none",
            "-chardev", console, "-serial", "chardev:console", "-chardev", line, "-serial", "chardev:line",
            *(["-D", events] if events else []), *[word for event in trace for word in ("-trace", event)], *more]


class Machine(Station):
    """with Machine("com86", "fieldling-dp") as m: m.pty is the line, m.ask("status")["state"] ... The image is a copy, so
    what the machine writes into its flash stays for the next Machine with flash=m.flash."""

    def __init__(self, board, image, flash=None, trace=(), more=()):
        self.folder = tempfile.mkdtemp(prefix="fieldling-")
        self.flash = flash or shutil.copy(image_path(board, image), self.folder)
        self.redirected = []
        self.events = f"{self.folder}/events"
        self._start(qemu(board, self.flash, "stdio,id=console,signal=off", "pty,id=line", trace, self.events, more))
        try:
            self.wait(lambda: self.redirected, "the line")
            self.pty = self.redirected[0]
            self.wait(self._console_answers, "the console")
        except BaseException:
            self.__exit__()
            raise

    def _read(self):
        for line in self.process.stdout:
            line = line.rstrip("\r\n")
            redirected = re.match(r"char device redirected to (\S+) \(label line\)", line)
            if redirected:
                self.redirected.append(redirected.group(1))
            elif line:
                self._answers.put(line)

    def _console_answers(self):
        """A machine that starts eats what is typed into it: ask until it answers, then until it has answered it all."""
        self.process.stdin.write("status\nsync\n")
        self.process.stdin.flush()
        try:
            while not self._answers.get(timeout=1.0).startswith("error=unknown-command"):
                pass
            while True:
                self._answers.get(timeout=0.05)
        except queue.Empty:
            pass
        return self.ask("status") and True
