"""A board's image in QEMU as a test sees it: like a Station, its line is a pseudo terminal, its console answers."""
import re
import shutil
import tempfile

from station import Station

BOARDS = {
    "com86": ["qemu-system-i386", "-M", "pc", "-cpu", "486", "-m", "1", "-no-reboot",
              "-device", "isa-debug-exit,iobase=0xf4,iosize=4"],
    "lm3s6965evb": ["qemu-system-arm", "-M", "lm3s6965evb", "-semihosting-config", "enable=on,target=native"],
}


class Machine(Station):
    """with Machine("com86", "fieldling-dp") as m: m.pty is the line, m.ask("status")["state"] ... The image is a copy, so
    what the machine writes into its flash stays for the next Machine with flash=m.flash."""

    def __init__(self, board, image, flash=None, trace=()):
        self.folder = tempfile.mkdtemp(prefix="fieldling-")
        suffix = "bin" if board == "com86" else "elf"
        self.flash = flash or shutil.copy(f"build/{board}/{image}.{suffix}", self.folder)
        self.redirected = []
        self.events = f"{self.folder}/events"
        command = [*BOARDS[board]]
        if board == "com86":
            command += ["-drive", f"if=pflash,format=raw,file={self.flash}"]
        else:
            command += ["-kernel", self.flash]
        command += ["-display", "none", "-nodefaults", "-monitor", "none", "-net", "none",
                    "-chardev", "stdio,id=console,signal=off", "-serial", "chardev:console",
                    "-chardev", "pty,id=line", "-serial", "chardev:line", "-D", self.events]
        for event in trace:
            command += ["-trace", event]
        self._start(command)
        self.wait(lambda: self.redirected, "the line")
        self.pty = self.redirected[0]
        self.wait(self._console_answers, "the console")

    def _read(self):
        for line in self.process.stdout:
            line = line.rstrip("\r\n")
            redirected = re.match(r"char device redirected to (\S+) \(label line\)", line)
            if redirected:
                self.redirected.append(redirected.group(1))
            elif line:
                self._answers.put(line)

    def _console_answers(self):
        try:
            return "state" in self.ask("status") or "mode" in self.ask("status")
        except AssertionError:
            return False
