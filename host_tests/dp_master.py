#!/usr/bin/env python3
"""fieldling-master as a person uses it: every command, its output and exit status, several slaves, faults, and slaves
that answer with E5 or have no outputs."""
import json
import os
import pty
import re
import subprocess
import sys
import tempfile
import threading
import time
import tty
from pathlib import Path

import scripted
from station import Station

TOP = Path(__file__).resolve().parent.parent
BIN = TOP / os.environ.get("FIELDLING_BIN", "build/posix")
GSD = "gsd/FLDL1234.GSD"
OK, REFUSED, USAGE, SILENT, LINE = range(5)


def master(line, *arguments, commands="", timeout=60):
    """-> exit status, output, errors. A slot time that a busy machine can keep, unless the arguments say another."""
    result = subprocess.run([str(BIN / "fieldling-master"), "--line", str(line), "--slot", "300", *map(str, arguments)], cwd=TOP,
                            input=commands.encode(), capture_output=True, timeout=timeout)
    return result.returncode, result.stdout.decode(), result.stderr.decode(errors="replace")


def said(line, *arguments, status=OK, **more):
    code, output, errors = master(line, "--json", *arguments, **more)
    assert code == status, f"exit {code}: {output}{errors}"
    return [json.loads(text) for text in output.splitlines()]


# ---- class 2 ----------------------------------------------------------------------------------------------------

def test_class_2_questions_before_parameters():
    with Station("fieldling-dp", "--address", "8") as s:
        assert said(s.pty, "ident", 8) == [{"station": 8, "vendor": "Fieldling", "controller": "DP-TEST01",
                                            "hardware": "V1.0", "software": "V0.1"}]
        # spec A6: not ready, parameters wanted, no owner
        assert said(s.pty, "diag", 8) == [{"station": 8, "ident": "0x1234", "master": "none",
                                           "status": ["Station_Not_Ready", "Prm_Req"], "octets": "02 05 00 FF 12 34",
                                           "extended": ""}]
        assert said(s.pty, "get-cfg", 8) == [{"station": 8, "cfg": "10 20 10 20"}]
        for verb in ("rd-inp", "rd-outp"):  # only in data exchange (facts 3.6)
            code, _, errors = master(s.pty, verb, 8)
            assert code == REFUSED and "RS: the service is not active" in errors, errors
        lsap = said(s.pty, "lsap", 8, 60)[0]
        assert lsap["sap"] == 60 and "SRD" in lsap["services"] and lsap["access"] == "all", lsap
        assert master(s.pty, "lsap", 8, 10)[0] == REFUSED
        assert said(s.pty, "--slot", 15, "--retries", 1, "live-list") == [{"count": 1, "stations": ["8 slave"]}]


def test_a_person_reads_words():
    with Station("fieldling-dp", "--address", "8") as s:
        code, output, _ = master(s.pty, "diag", 8)
        assert code == OK and re.search(r"^status +Station_Not_Ready, Prm_Req$", output, re.M), output


def test_a_station_that_is_not_there():
    with Station("fieldling-dp", "--address", "8") as s:
        code, output, errors = master(s.pty, "diag", 9)
        assert (code, output) == (SILENT, "") and "station 9 does not answer" in errors, errors


def test_an_address_is_set_and_kept():
    with tempfile.TemporaryDirectory() as folder:
        nv = folder + "/nv"
        with Station("fieldling-dp", "--nv", nv) as s:
            assert master(s.pty, "--slot", 60, "set-address", 126, 17, "0x4321")[0] == REFUSED  # another ident
            assert said(s.pty, "set-address", 126, 17, "0x1234", "lock") == [{"old": 126, "station": 17,
                                                                               "no_add_chg": "yes"}]
            assert said(s.pty, "diag", 17)[0]["station"] == 17
        with Station("fieldling-dp", "--nv", nv) as s:
            assert said(s.pty, "ident", 17)[0]["station"] == 17
            assert master(s.pty, "--slot", 60, "set-address", 17, 18, "0x1234")[0] == REFUSED  # locked


def test_wrong_usage_is_told_in_one_line():
    with Station("fieldling-dp", "--address", "8") as s, tempfile.TemporaryDirectory() as folder:
        bad_gsd = Path(folder) / "bad.gsd"
        bad_gsd.write_text("#Profibus_DP\nModule=5\n")
        for arguments, text in (
                ([], "a command is missing"), (["fly"], "no such command"), (["diag"], "usage: COMMAND STATION"),
                (["diag", "127"], "usage"), (["lsap", "8"], "lsap STATION SAP"), (["set-address", "8"], "usage"),
                (["--rate", "x", "diag", "8"], "--rate: a number"), (["cyclic"], "no slave"),
                (["--slave", "8", "cyclic"], "N=FILE.GSD"), (["--slave", "8=none.gsd", "cyclic"], "No such file"),
                (["--slave", f"8={bad_gsd}", "cyclic"], "line 2: Module: a name in quotation marks"),
                (["--slave", f"2={GSD}", "cyclic"], "slave 2 has the master's address"),
                (["--slave", f"8={GSD}", "--slave", f"8={GSD}", "cyclic"], "slave 8 again"),
                (["--slave", f"8={GSD}", "--module", "Nothing", "cyclic"], 'has no module "Nothing"')):
            code, output, errors = master(s.pty, *arguments)
            assert code == USAGE and text in errors and output == "" and errors.count("\n") == 1, (arguments, errors)
    code, _, errors = master("/no/such/line", "diag", 8)
    assert code == LINE and "No such file" in errors, errors
    assert subprocess.run([str(BIN / "fieldling-master"), "--help"], capture_output=True).returncode == OK


# ---- class 1 ----------------------------------------------------------------------------------------------------

CONFIG = """# one slave, its modules by name
address 3
slave 8
  gsd {gsd}
  module "Temperature, 1 byte in"
  module "Output 1, 1 byte out"
  module "Sensor, 1 byte in"
  module "Output 2, 1 byte out"
  watchdog 300
  group 05
  sync
  freeze
  min-tsdr 20
  outputs 11 22
"""


def test_cyclic_from_a_text_file():
    with Station("fieldling-dp", "--address", "8") as s, tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "bus.conf"
        config.write_text(CONFIG.format(gsd=TOP / GSD))
        s.ask("in 1 32")
        slave, whole = said(s.pty, "--cycles", 50, "--cycle", 1, "cyclic", config)
        assert slave["state"] == "exchange" and slave["starts"] == 1 and slave["lost"] == 0, slave
        assert (slave["inputs"], slave["outputs"]) == ("20 00", "11 22")
        assert whole["cycles"] == 50 and whole["retries"] == 0, whole
        status = s.ask("status")
        assert (status["master"], status["groups"]) == ("3", "05"), status
        assert s.ask("out")["out"] == "1122"


def test_a_wrong_line_of_the_text_file_is_named():
    with Station("fieldling-dp", "--address", "8") as s, tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "bus.conf"
        for text, what in (("slave 8\n  watchdog 5\n", "line 2: watchdog 5: 10 to 650250 ms"),
                           ("cfg 10\n", 'line 1: "cfg" before the first slave'),
                           ("slave 8\n cfg 10\n wings 2\n", 'line 3: "wings" is not known'),
                           ("slave 8\n cfg 1G\n", "line 2: cfg 1G: not a value"),
                           ("slave 8\n", "slave 8 has no configuration"),
                           ("slave 8\n cfg C4 87\n", "identifier bytes are cut short"),
                           ("slave 126\n", "line 1: slave 126: an address is 0 to 125")):
            config.write_text(text)
            code, _, errors = master(s.pty, "cyclic", config)
            assert code == USAGE and what in errors, (text, errors)


class Running:
    """fieldling-master, with commands given while it runs."""

    def __init__(self, line, *arguments):
        self.process = subprocess.Popen([str(BIN / "fieldling-master"), "--line", str(line), "--slot", "300",
                                         *map(str, arguments)], cwd=TOP, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def say(self, text):
        self.process.stdin.write(text.encode() + b"\n")
        self.process.stdin.flush()

    def end(self):
        output, _ = self.process.communicate(b"quit\n", timeout=30)
        return self.process.returncode, output.decode()


def test_commands_while_it_runs():
    """Outputs reach the station; Sync holds them (the Set_Prm of --slave does not ask for Sync: so by a text file)."""
    with Station("fieldling-dp", "--address", "8") as s, tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "bus.conf"
        config.write_text(CONFIG.format(gsd=TOP / GSD))
        with Running(s.pty, "--cycle", 2, "cyclic", config) as m:
            s.wait(lambda: s.ask("out")["out"] == "1122", "first outputs")
            m.say("out 8 AB CD")
            s.wait(lambda: s.ask("out")["out"] == "ABCD", "new outputs")
            m.say("sync 04")
            s.wait(lambda: s.ask("status")["sync"] == "1", "Sync")
            m.say("out 8 01 02")
            before = int(s.ask("status")["data_exchange"])
            s.wait(lambda: int(s.ask("status")["data_exchange"]) > before + 5, "exchanges")
            assert s.ask("out")["out"] == "ABCD"
            m.say("unsync 04")
            s.wait(lambda: s.ask("out")["out"] == "0102", "outputs after Unsync")
            m.say("freeze")
            s.wait(lambda: s.ask("status")["freeze"] == "1", "Freeze")
            m.say("unfreeze")
            s.wait(lambda: s.ask("status")["freeze"] == "0", "Unfreeze")
            m.say("clear")
            s.wait(lambda: s.ask("out")["out"] == "0000", "Clear")
            m.say("operate")
            s.wait(lambda: s.ask("out")["out"] == "0102", "Operate")
            m.say("dance")
            code, output = m.end()
        assert code == OK and "commands: out SLAVE" in output, output


def test_the_watchdog_of_an_ended_master_expires():
    with Station("fieldling-dp", "--address", "8") as s:
        assert said(s.pty, "--slave", f"8={GSD}", "--cycles", 20, "cyclic")[0]["state"] == "exchange"
        s.wait(lambda: s.ask("status")["state"] == "WAIT_PRM", "watchdog")  # 500 ms
        assert s.ask("status")["wd_expired"] == "1"


def test_diagnosis_comes_through():
    with Station("fieldling-dp", "--address", "8") as s, Running(s.pty, "--slave", f"8={GSD}", "--cycle", 2, "cyclic") as m:
        s.wait(lambda: s.ask("status")["state"] == "DATA_EXCH", "data exchange")
        s.ask("diag 0207")
        time.sleep(0.3)
        code, output = m.end()
        assert code == OK and "diagnosis 08 0C 00 02 12 34 02 07" in output, output


def test_damaged_files_are_refused_or_read_but_never_stop_it():
    """The line does not exist: exit status 4 means that the file was read."""
    import random
    source, seen = random.Random(3), set()
    good = {".gsd": (TOP / GSD).read_bytes(), ".conf": CONFIG.format(gsd=TOP / GSD).encode()}
    with tempfile.TemporaryDirectory() as folder:
        for i in range(400 if os.environ.get("TEST_FULL") else 60):
            kind = (".gsd", ".conf")[i % 2]
            text = bytearray(good[kind])
            for _ in range(source.randrange(1, 8)):
                at = source.randrange(len(text))
                text[at:at + source.randrange(40)] = bytes(source.choices(b'"=;()\\\r\n0xF,- aZ9\xff\0', k=source.randrange(30)))
            path = Path(folder) / ("bus" + kind)
            path.write_bytes(text)
            arguments = ["--slave", f"8={path}", "cyclic"] if kind == ".gsd" else ["cyclic", path]
            code, _, errors = master("/no/such/line", *arguments)
            assert code in (USAGE, LINE) and errors.count("\n") == 1, (code, errors, bytes(text))
            seen.add(code)
    assert seen == {USAGE, LINE}


class Segment:
    """fieldling-segment with ports 0..n-1."""

    def __init__(self, n, *arguments):
        self.folder = tempfile.TemporaryDirectory()
        self.ports = [f"{self.folder.name}/{i}" for i in range(n)]
        self.process = subprocess.Popen([str(BIN / "fieldling-segment"), *arguments, *self.ports], stdout=subprocess.PIPE)
        self.process.stdout.readline()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()


def stations(segment, addresses):
    """Processes at the ports from 2 on; port 0 is the master's, port 1 the analyzer's."""
    return [subprocess.Popen([str(BIN / "fieldling-dp"), "--line", segment.ports[2 + i], "--address", str(address),
                              "--baud", "500000"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                             stderr=subprocess.DEVNULL) for i, address in enumerate(addresses)]


def test_several_slaves_and_one_that_is_missing():
    with Segment(5) as segment:
        processes = stations(segment, (10, 11, 12))
        try:
            arguments = [a for n in (10, 11, 12, 13) for a in ("--slave", f"{n}={GSD}")]
            time.sleep(0.3)
            *slaves, whole = said(segment.ports[0], *arguments, "--slot", 40, "--retries", 2, "--cycles", 12, "cyclic",
                                    status=REFUSED)
            assert [s["state"] for s in slaves] == ["exchange"] * 3 + ["absent"], slaves
            assert all(s["lost"] == 0 for s in slaves[:3]) and slaves[3]["lost"] >= 10, slaves
        finally:
            for process in processes:
                process.terminate()
                process.wait()


def test_a_bad_line_is_survived_by_retries():
    with Segment(3, "--fault", "LOST_REQUEST:8", "--seed", "5") as segment:
        processes = stations(segment, (10,))
        try:
            time.sleep(0.3)
            slave, whole = said(segment.ports[0], "--slave", f"10={GSD}", "--slot", 25, "--retries", 6, "--cycles", 300,
                                "--cycle", 0, "cyclic")
            assert slave["exchanges"] >= 280 and slave["lost"] == 0 and whole["retries"] >= 20, (slave, whole)
        finally:
            processes[0].terminate()
            processes[0].wait()


def test_the_analyzer_taps_the_segment():
    with Segment(3) as segment:
        processes = stations(segment, (10,))
        mon = subprocess.Popen([str(BIN / "fieldling-mon"), "--rate", "500000", "--summary", segment.ports[1]],
                               stdout=subprocess.PIPE)
        try:
            time.sleep(0.3)
            said(segment.ports[0], "--slave", f"10={GSD}", "--cycles", 30, "cyclic")
            time.sleep(0.2)
            mon.terminate()
            lines = mon.communicate(timeout=10)[0].decode().splitlines()
        finally:
            processes[0].terminate()
            processes[0].wait()
            mon.kill()
        what = [" ".join(line.split()[3:]) for line in lines]
        # FDL status, diagnosis, parameters, configuration, diagnosis, data (facts 2.1)
        order = ["2 -> 10 FDL req. FDL Status", "10 -> 2 FDL res. FDL Status, OK, slave", "2.62 -> 10.60 DP req. Slave Diag",
                 "10.60 -> 2.62 DP res. Slave Diag", "2.62 -> 10.61 DP req. Set Prm",
                 "(10 -> 2) FDL res. short acknowledge of Set Prm", "2.62 -> 10.62 DP req. Chk Cfg",
                 "(10 -> 2) FDL res. short acknowledge of Chk Cfg", "2 -> 10 DP req. Data Exchange",
                 "10 -> 2 DP res. Data Exchange"]
        at = -1
        for text in order:
            assert text in what[at + 1:], f"{text} does not follow in\n" + "\n".join(what[:40])
            at = what.index(text, at + 1)
        assert mon.returncode == OK and any("0 wrong" in line for line in lines), lines[-4:]


# ---- slaves that this project does not have -----------------------------------------------------------------------

class PlayedSlave:
    """A slave at address 5 as the standard describes it, written out; answers data exchange with `answer`."""

    def __init__(self, exchange):
        self.master, slave = pty.openpty()
        tty.setraw(self.master)
        tty.setraw(slave)
        self.line, self.exchange, self.asked = os.ttyname(slave), exchange, []
        self.keep, self.configured, self.ended = slave, False, False
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.ended = True
        os.write(self.keep, b"\xe5")  # wakes the thread
        self.thread.join(5)
        os.close(self.keep)
        os.close(self.master)

    def run(self):
        buffer = b""
        while not self.ended:
            buffer += os.read(self.master, 512)
            while buffer:
                n = {0x10: 6, 0xA2: 14, 0xDC: 3, 0xE5: 1}.get(buffer[0]) or (buffer[1] + 6 if len(buffer) > 1 else 6)
                if len(buffer) < n:
                    break
                self.answer(buffer[:n])
                buffer = buffer[n:]

    def answer(self, request):
        body = request[4:-2] if request[0] == 0x68 else request[1:-2]
        if len(body) < 3 or body[0] & 0x7F != 5:
            return
        if body[2] & 0x0F == 9:
            os.write(self.master, bytes.fromhex("10 02 05 00 07 16"))
        elif body[0] & 0x80 and body[3] == 60:
            status = (0x00, 0x0C, 0x00, 0x02) if self.configured else (0x02, 0x05, 0x00, 0xFF)
            text = bytes((0x82, 0x85, 0x08, 62, 60, *status, 0x77, 0x88))
            os.write(self.master, bytes((0x68, len(text), len(text), 0x68)) + text + bytes((sum(text) % 256, 0x16)))
        elif body[0] & 0x80 and body[3] in (61, 62):
            self.configured = body[3] == 62
            os.write(self.master, b"\xe5")
        elif not body[0] & 0x80:
            self.asked.append(request)
            os.write(self.master, self.exchange)


def played(exchange, cfg, status=OK):
    with PlayedSlave(exchange) as slave, tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "bus.conf"
        config.write_text(f"slave 5\n ident 0x7788\n cfg {cfg}\n outputs AA\n")
        return *said(slave.line, "--cycles", 30, "--cycle", 1, "cyclic", config, status=status), slave.asked


def test_a_slave_without_inputs_answers_with_e5():
    slave, whole, asked = played(b"\xe5", "20")
    assert slave["state"] == "exchange" and slave["exchanges"] >= 20 and slave["wrong"] == 0, slave
    # one octet out, FCB toggles: 05 02 7D AA, 05 02 5D AA
    assert {a.hex() for a in asked} == {"680404680502" + "7daa2e16", "680404680502" + "5daa0e16"}, asked
    assert whole["retries"] == 0


def test_a_slave_without_outputs_is_asked_with_sd1():
    slave, _, asked = played(bytes.fromhex("68 04 04 68 02 05 08 C3 D2 16"), "10")
    assert slave["state"] == "exchange" and slave["inputs"] == "C3" and slave["wrong"] == 0, slave
    # 05 + 02 + 7D = 84, 05 + 02 + 5D = 64
    assert {a.hex() for a in asked} == {"1005027d8416", "1005025d6416"}, asked


def test_data_of_another_length_are_not_taken():
    slave, _, _ = played(bytes.fromhex("68 05 05 68 02 05 08 C3 C3 95 16"), "10", REFUSED)
    assert slave["inputs"] == "00" and slave["exchanges"] == 0 and slave["wrong"] >= 10, slave


def test_eight_stations_run_as_make_run_shows_them():
    result = subprocess.run(["sh", "sim/run_stations.sh", "8", "2"], cwd=TOP, stdin=subprocess.DEVNULL, capture_output=True,
                            timeout=60, env=dict(os.environ, FIELDLING_BIN=str(BIN)))
    output = result.stdout.decode()
    assert result.returncode == OK, output + result.stderr.decode()
    rows = re.findall(r"^ +(\d+) DP-TEST01 +exchange +(\d+)", output, re.M)
    assert [int(r[0]) for r in rows] == list(range(10, 18)) and all(int(r[1]) > 20 for r in rows), output
    assert subprocess.run(["sh", "sim/run_stations.sh", "15"], cwd=TOP, capture_output=True).returncode == USAGE


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), __file__))
