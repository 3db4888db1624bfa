#!/usr/bin/env python3
"""The HDLC host programs as their users have them: a remote module on a pseudo terminal, the line, the master station;
and their frames read by somebody else's decoder (tshark, link type SDLC)."""
import fcntl
import json
import os
import pty
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time
import tty

import scripted
from station import PATIENCE, Station

BIN = os.environ.get("FIELDLING_BIN", "build/posix")
MASTER, CABLE, MODULE = (os.path.join(BIN, "fieldling-hdlc" + tail) for tail in ("-master", "-cable", ""))


def line_bits(text):
    """Bits as on the line, first one first -> octets of the pseudo terminal."""
    text += "1" * (-len(text) % 8)
    return bytes(int(text[i:i + 8][::-1], 2) for i in range(0, len(text), 8))


def exchange(path, request):
    fd = os.open(path, os.O_RDWR | os.O_NOCTTY)
    try:
        tty.setraw(fd)
        os.write(fd, request)
        heard, end = b"", time.monotonic() + PATIENCE
        while time.monotonic() < end and len(heard) < 6:
            if select.select([fd], [], [], 0.05)[0]:
                heard += os.read(fd, 100)
        return heard
    finally:
        os.close(fd)


# Facts 2.6: SNRM P to station 5, bit for bit; UA F is 7E 05 73 E3 30 7E without an inserted zero.
SNRM_LINE = "0111111010100000110010011011011111010101101111110"


def test_a_module_answers_on_the_line_of_bits():
    with Station("fieldling-hdlc", "--type", "di", "--address", "5") as s:
        assert exchange(s.pty, line_bits(SNRM_LINE)).hex() == "7e0573e3307e"
        assert s.ask("status")["state"] == "NRM"


def test_a_module_answers_in_octets():
    with Station("fieldling-hdlc", "--type", "di", "--address", "5", "--coding", "octets") as s:
        s.ask("in 3 1")
        time.sleep(0.1)  # a sampling period
        # the document's own frame and its answer, FCS from facts 2.6
        assert exchange(s.pty, bytes.fromhex("7e05080103087f7e")).hex() == "7e0509010331fe407e"
        assert exchange(s.pty, bytes.fromhex("7e0593edd77e")).hex() == "7e0573e3307e"
        assert exchange(s.pty, bytes.fromhex("7e0593edd67e7e0511f7707e")).hex() == "7e0511f7707e"  # a bad FCS first


def test_a_module_escapes_flags_in_octets():
    with Station("fieldling-hdlc", "--type", "ao", "--address", "5", "--coding", "octets") as s:
        exchange(s.pty, bytes.fromhex("7e0593edd77e"))
        # TEST P with information 7E: FCS of 05 F3 7E by hand: CRC-16/X-25
        crc = 0xFFFF
        for octet in (0x05, 0xF3, 0x7E):
            crc ^= octet
            for _ in range(8):
                crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
        frame = bytes((0x7E, 0x05, 0xF3, 0x7D, 0x5E)) + struct.pack("<H", crc ^ 0xFFFF) + b"\x7e"
        assert exchange(s.pty, frame) == frame


def refused(*command):
    r = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert r.returncode == 2, (command, r.returncode)
    assert r.stderr.count("\n") == 1 and r.stdout == "", (command, r.stderr)
    return r.stderr


def test_unusable_arguments_end_with_one_line_and_status_2():
    folder = tempfile.mkdtemp(prefix="fieldling-")
    conf = os.path.join(folder, "conf")
    try:
        refused(MODULE)
        refused(MODULE, "--line", "pty:" + folder + "/x")
        refused(MODULE, "--line", "pty:" + folder + "/x", "--type", "dx")
        refused(MODULE, "--line", "pty:" + folder + "/x", "--type", "di", "--address", "31")
        refused(MODULE, "--line", "pty:" + folder + "/x", "--type", "di", "--coding", "morse")
        refused(CABLE)
        refused(CABLE, "--ends", "one")
        refused(MASTER, "--line", "pty:" + folder + "/x")
        for text, place in (("", ":0:"), ("module a 1 di\n", ":1:"), ("# c\nmodule a 31 di 100\n", ":2:"),
                            ("module a 1 xx 100\n", ":1:"), ("module a 1 di 100 channels 0-16\n", ":1:"),
                            ("module a 1 ai 100 channels 0\n", ":1:"), ("module a 1 di 1\nmodule b 1 di 1\n", ":2:"),
                            ("module a 1 di 1\nmodule a 2 di 1\n", ":2:"), ("timeout x\n", ":1:"),
                            ("speed 3\n", ":1:")):
            with open(conf, "w", encoding="ascii") as f:
                f.write(text)
            said = refused(MASTER, "--line", "pty:" + folder + "/x", "--config", conf, "--batch", "1")
            assert conf + place in said, (text, said)
    finally:
        shutil.rmtree(folder)


def test_the_console_refuses_what_it_cannot_do():
    with Station("fieldling-hdlc", "--type", "do", "--address", "0") as s:
        for line in ("in 0 1", "fault wire on", "busy", "trace maybe", "nonsense", "out 1", "status now"):
            assert "error" in s.ask(line), line
        assert s.ask("out") == {"out": "0000"}
        assert s.ask("fault ram on")["fault"] == "ram"


class Plant:
    """Modules, the line, a folder. with Plant("di 1", "do 2") as p: p.master("module ...", "commands") -> events"""

    def __init__(self, *modules, cable=()):
        self.folder = tempfile.mkdtemp(prefix="fieldling-")
        self.processes = {}
        self.modules = modules
        for m in modules:
            self.start(m)
        ends = ",".join(os.path.join(self.folder, e) for e in [m.replace(" ", "") for m in modules] + ["master"])
        self.processes["cable"] = subprocess.Popen([CABLE, "--ends", ends, *cable])

    def start(self, module):
        kind, address = module.split()
        self.processes[module] = subprocess.Popen(
            [MODULE, "--line", f"pty:{self.folder}/{kind}{address}", "--type", kind, "--address", address],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)

    def stop(self, module):
        process = self.processes.pop(module)
        process.terminate()
        process.wait(PATIENCE)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for module in list(self.processes):
            self.stop(module)
        shutil.rmtree(self.folder, ignore_errors=True)

    def start_master(self, config, seconds):
        conf = os.path.join(self.folder, "conf")
        with open(conf, "w", encoding="ascii") as f:
            f.write(config)
        command = [MASTER, "--line", f"pty:{self.folder}/master", "--config", conf, "--batch", str(seconds), "--json"]
        return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def master(self, config, commands, seconds=60):
        process = self.start_master(config, seconds)
        out, _ = process.communicate(commands, timeout=seconds + 2 * PATIENCE)
        return [json.loads(line) for line in out.splitlines()], process.returncode


def pick(events, event, **wanted):
    return [e for e in events if e["event"] == event and all(e.get(k) == v for k, v in wanted.items())]


def test_master_and_four_modules():
    with Plant("di 1", "do 2", "ai 3", "ao 4", cable=("--rate", "0")) as p:
        events, status = p.master(
            "module in 1 di 100\nmodule out 2 do 100\nmodule ain 3 ai 100 channels 1-2,6\nmodule aout 4 ao 100\n",
            "wait 1500\nset out 3 1\nset 2 16 1\nset aout 6 4095\nset aout 1 4096\nget ain 7\nsamples in 0\n"
            "samples out 0\ndiag out\noff in\nwait 300\nstatus\nnonsense\nset nobody 1 1\non in\nwait 1500\nquit\n")
        assert status == 0, events
        assert pick(events, "control", module="out", channel=3, outcome="done", value=1)
        assert pick(events, "control", module="out", channel=16, outcome="refused", reason="channel")
        assert pick(events, "control", module="aout", channel=6, outcome="done", value=4095)
        assert pick(events, "control", module="aout", channel=1, outcome="refused", reason="value")
        assert pick(events, "data", module="ain", channel=7, outcome="refused", reason="channel")
        samples = pick(events, "samples", module="in", outcome="done")[0]
        assert samples["count"] == len(samples["values"]) > 50 and set(samples["values"]) <= {0, 1}, samples
        assert pick(events, "samples", module="out", outcome="refused", reason="function")
        assert pick(events, "diagnosis", module="out", page=0, type=2, faults=0)
        assert pick(events, "diagnosis", module="out", page=1, executed=1)
        assert pick(events, "module", module="in", state="disabled")
        assert len(pick(events, "error")) == 2
        last = {e["module"]: e for e in pick(events, "module")[-4:]}
        assert all(m["state"] == "online" and m["frmr"] + m["dm"] == 0 for m in last.values()), last
        known = [v is not None for v in last["ain"]["values"]]
        assert known == [True, True, False, False, False, True], known
        assert None not in last["in"]["values"]


def test_a_master_directly_on_a_module_in_both_codings():
    for coding in ("bits", "octets"):
        with Station("fieldling-hdlc", "--type", "ao", "--address", "5", "--coding", coding) as s:
            conf = os.path.join(s.folder, "conf")
            with open(conf, "w", encoding="ascii") as f:
                f.write("module m 5 ao 200\n")
            command = [MASTER, "--line", s.pty, "--config", conf, "--coding", coding, "--batch", "30", "--json"]
            # 7E7DH holds both octets that the coding must escape, and is refused; 0F7EH is a value
            r = subprocess.run(command, input="set m 1 32381\nset m 2 3966\nquit\n", capture_output=True, text=True,
                               timeout=4 * PATIENCE, check=False)
            events = [json.loads(line) for line in r.stdout.splitlines()]
            assert r.returncode == 0, (coding, events)
            assert pick(events, "control", channel=1, outcome="refused", reason="value"), (coding, events)
            assert pick(events, "control", channel=2, outcome="done", value=3966), (coding, events)
            assert s.ask("out")["out"] == "0,3966,0,0,0,0"


def test_the_master_builds_without_ncurses():
    sources = ["boards/posix/" + name for name in ("fieldling_hdlc_master.c", "master_screen_none.c", "master_commands.c",
               "master_config.c", "report.c", "hdlc_line.c", "options.c")]
    sources += ["sim/" + name for name in ("hdlc_primary.c", "i8273.c", "i8273_line.c", "hdlc_bits.c")]
    sources += ["firmware/hal/posix/" + name for name in ("hal_8273_model.c", "hal_realtime.c", "line_pty.c",
                                                          "line_tty.c", "nv_file.c", "con_stdio.c")]
    with Station("fieldling-hdlc", "--type", "do", "--address", "1") as s:
        program, conf = os.path.join(s.folder, "master"), os.path.join(s.folder, "conf")
        subprocess.run(["gcc", "-std=c99", "-D_DEFAULT_SOURCE", "-I.", "-Ifirmware", "-Ifirmware/hal/posix",
                        "-Iboards/common", *sources, "firmware/hdlc/hdlc_8273.c", "-o", program], check=True)
        with open(conf, "w", encoding="ascii") as f:
            f.write("module m 1 do 100\n")
        said = refused(program, "--line", s.pty, "--config", conf)
        assert "built without a screen" in said and "--batch" in said
        r = subprocess.run([program, "--line", s.pty, "--config", conf, "--batch", "2"], stdin=subprocess.DEVNULL,
                           capture_output=True, text=True, timeout=PATIENCE, check=False)
        assert r.returncode == 0 and "online=1" in r.stdout, r.stdout


def test_document_mode():
    with Plant("di 1", "do 2", cable=("--rate", "0")) as p:
        events, status = p.master("module in 1 di 200 document\nmodule out 2 do 0 document\n",
                                  "wait 1500\nset out 0 1\nset out 16 1\nset out 1 1\nquit\n")
        assert status == 0, events
        assert len(pick(events, "control", outcome="done", value=1)) == 2
        assert pick(events, "control", channel=16, outcome="unknown")  # silence is all this mode has to say
        assert None not in pick(events, "module", module="in")[-1]["values"]


def test_a_module_switched_off_and_on_again():
    with Plant("di 1", "do 2", cable=("--rate", "0")) as p:
        process = p.start_master("timeout 100\nretry 200\nmodule in 1 di 200\nmodule out 2 do 200\n", 60)
        events = []

        def until(event, **wanted):
            end = time.monotonic() + 2 * PATIENCE
            while time.monotonic() < end:
                events.append(json.loads(process.stdout.readline()))
                if pick(events[-1:], event, **wanted):
                    return
            raise AssertionError(f"no {event} {wanted}: {events}")

        def tell(text):
            process.stdin.write(text)
            process.stdin.flush()

        tell("wait 1000\nset out 1 1\n")
        until("control", channel=1, outcome="done")
        p.stop("do 2")
        until("trouble", module="out", what="does not answer")
        tell("wait 1000\nset out 2 1\n")
        until("control", channel=2, outcome="not-sent")
        p.start("do 2")
        tell("wait 2000\nset out 3 1\nstatus\n")
        until("control", channel=3, outcome="done")
        until("module", module="out", state="online")
        tell("quit\n")
        out, _ = process.communicate(timeout=PATIENCE)
        assert process.returncode == 0, out
        assert pick([json.loads(x) for x in out.splitlines()], "module", module="in", state="online"), out


def test_controls_are_carried_out_once_on_a_bad_line():
    controls = "".join(f"set out {k % 16} {k // 16 % 2}\n" for k in range(1, 61))
    commands = "wait 1000\n" + controls + "wait 200\ndiag out\nquit\n"
    with Plant("do 2", cable=("--rate", "0", "--bit-errors", "700", "--seed", "5")) as p:
        events, _ = p.master("timeout 60\nmisses 20\nmodule out 2 do 1000\n", commands)
        done = pick(events, "control", module="out")
        assert len(done) == 60 and {e["outcome"] for e in done} == {"done"}, done
        assert [(e["channel"], e["value"]) for e in done] == [(k % 16, k // 16 % 2) for k in range(1, 61)]
        diagnosis = pick(events, "diagnosis", page=1, outcome="done")[-1]
        assert diagnosis["executed"] == 60, diagnosis
        module = pick(events, "module", module="out")[-1]
        assert module["repeats"] > 0 and module["connects"] == 1, module  # the line was bad, indeed


def screen_of(arguments, keys, size=(24, 120)):
    """Run a program on a terminal of its own -> all it wrote there, exit status."""
    pid, fd = pty.fork()
    if pid == 0:
        os.environ["TERM"] = "xterm"
        os.execv(arguments[0], arguments)
    fcntl.ioctl(fd, termios.TIOCSWINSZ, struct.pack("HHHH", *size, 0, 0))
    seen, start = b"", time.monotonic()
    while time.monotonic() < start + 2 * PATIENCE:
        if keys and time.monotonic() - start > keys[0][0]:
            os.write(fd, keys.pop(0)[1])
        if select.select([fd], [], [], 0.05)[0]:
            try:
                chunk = os.read(fd, 65536)
            except OSError:
                break
            seen += chunk
    return seen.decode(errors="replace"), os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def test_the_screen():
    with Plant("di 1", "do 2", cable=("--rate", "0")) as p:
        conf = os.path.join(p.folder, "conf")
        with open(conf, "w", encoding="ascii") as f:
            f.write("module switches 1 di 200\nmodule pumps 2 do 200\n")
        text, status = screen_of([MASTER, "--line", f"pty:{p.folder}/master", "--config", conf],
                                 [(1.5, b"set pumps 3 1\n"), (2.5, b"quit\n")])
        if "built without a screen" in text:
            return "built without ncurses"
        assert status == 0, text
        for word in ("switches", "pumps", "online", "line load", "channel=3 outcome=done value=1"):
            assert word in text, (word, text)
    return None


def test_the_demonstration():
    r = subprocess.run(["sh", "boards/posix/hdlc_demo.sh"], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                       timeout=6 * PATIENCE, check=False)
    assert r.returncode == 0, r.stdout + r.stderr
    assert "online=4 modules=4" in r.stdout, r.stdout


def test_31_modules_on_one_line():
    for arguments in ([], ["--document"]):
        r = subprocess.run([os.path.join(BIN, "fieldling-hdlc-scan"), *arguments], capture_output=True, text=True,
                           timeout=18 * PATIENCE, check=False)
        assert r.returncode == 0, r.stdout
        said = dict(pair.split("=") for pair in r.stdout.split() if "=" in pair)
        assert said["modules"] == "31" and said["collisions"] == "0", said
        assert 1.0 <= float(said["ratio"]) < 1.05, said


# ---- tshark ----------------------------------------------------------------------------------------------

UNNUMBERED = {0x03: "UI", 0x07: "RIM", 0x0F: "DM", 0x23: "UP", 0x33: "UP", 0x43: "RD", 0x63: "UA", 0x83: "SNRM",
              0x87: "FRMR", 0x8F: "RESET", 0xAF: "XID", 0xCF: "SNRME", 0xE3: "TEST", 0x6F: "SABME"}


def dissect(path):
    """-> [(control, text)] of every frame, as tshark reads it"""
    fields = ["-e", "sdlc.address", "-e", "sdlc.control", "-e", "_ws.col.Info"]
    r = subprocess.run(["tshark", "-r", path, "--disable-protocol", "sna", "-T", "fields", *fields],
                       capture_output=True, text=True, timeout=6 * PATIENCE, check=True)
    rows = [line.split("\t") for line in r.stdout.splitlines()]
    return [(int(control, 16), info) for _, control, info in rows]


def check_dissection(frames):
    kinds = set()
    for control, info in frames:
        if control & 1 == 0:
            kinds.add("I")
            assert f"N(R)={control >> 5}, N(S)={control >> 1 & 7}" in info, (hex(control), info)
        elif control & 3 == 1:
            kind = ("RR", "RNR", "REJ", "SREJ")[control >> 2 & 3]
            kinds.add(kind)
            assert f"func={kind}, N(R)={control >> 5}" in info, (hex(control), info)
        else:
            kind = UNNUMBERED.get(control & 0xEF)
            kinds.add(kind)
            assert "U" in info and (kind is None or f"func={kind}" in info), (hex(control), info, kind)
    return kinds


def test_tshark_reads_the_frames_of_every_row_of_the_state_table():
    if not shutil.which("tshark"):
        return "no tshark here"
    with tempfile.NamedTemporaryFile(suffix=".pcap") as f:
        directory = "build/test" if BIN == "build/posix" else "build/asan"
        subprocess.run([directory + "/test_hdlc_nrm"], env=dict(os.environ, HDLC_PCAP=f.name), check=True,
                       stdout=subprocess.DEVNULL, timeout=6 * PATIENCE)
        frames = dissect(f.name)
    assert len(frames) > 200, len(frames)
    kinds = check_dissection(frames)
    assert {"I", "RR", "RNR", "REJ", "SNRM", "UA", "DM", "FRMR", "UI", "TEST", "XID"} <= kinds, kinds
    return None


def test_tshark_reads_what_the_master_and_the_modules_say():
    if not shutil.which("tshark"):
        return "no tshark here"
    with tempfile.NamedTemporaryFile(suffix=".pcap") as f:
        with Plant("di 1", "do 2", cable=("--rate", "0", "--capture", f.name)) as p:
            p.master("module in 1 di 100\nmodule out 2 do 100\n", "wait 1500\nset out 1 1\noff in\nwait 300\nquit\n")
        frames = dissect(f.name)
    assert len(frames) > 50, len(frames)
    assert {"SNRM", "UA", "I", "RR"} <= check_dissection(frames)
    return None


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), "host_tests/hdlc_host.py"))
