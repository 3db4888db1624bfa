#!/usr/bin/env python3
"""sim/wireshark/profibus_dp.lua in the distribution's tshark, on files of the analyzer, against hand-worked values."""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import scripted

TOP = Path(__file__).resolve().parent.parent
MON = Path(os.environ.get("FIELDLING_BIN", "build/posix")) / "fieldling-mon"
LUA = TOP / "sim/wireshark/profibus_dp.lua"
TSHARK = shutil.which("tshark")

# Requests end 22 us an octet after they begin; T_SDR 28 us = 14 T_bit (see mon_views.py).
WRONG = """# rate 500000
1.000000 68 05 05 68 88 82 6D 3C 3E F2 16
1.001000 68 05 06 68 88 82 6D 3C 3E F1 16
1.002000 10 08 02! 49 53 16
1.003000 68 05 05 68 03 02 7D 01 02 85 16
1.003270 10 02 03 03 08 16
1.004000 68 05 05 68 03 02 7D 01 02 85 16
1.005000 10 02 03 08 0D 16
1.006000 10 02 03 08 0D 16
1.007000 68 07 07 68
"""


def tshark(record, *fields):
    """-> list of dicts, one a packet, of the fields that are there."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus.pcapng"
        subprocess.run([str(MON), "-q", "-w", str(path), "-"], input=record.encode(), cwd=TOP, timeout=30)
        arguments = ["-T", "fields", "-E", "separator=|", "-E", "occurrence=a", "-E", "aggregator=;"]
        for name in fields:
            arguments += ["-e", name]
        result = subprocess.run([TSHARK, "-2", "-n", "-X", f"lua_script:{LUA}", "-r", str(path), *arguments],
                                capture_output=True, timeout=60, env=dict(os.environ, HOME=folder))
        errors = [line for line in result.stderr.decode().splitlines() if "Running as user" not in line]
        assert result.returncode == 0 and not errors, errors
        return [dict(zip(fields, line.split("|"))) for line in result.stdout.decode().splitlines()]


def dp(packets, number, **wanted):
    """Field names with __ for a dot; values as tshark prints them."""
    packet = packets[number - 1]
    for name, value in wanted.items():
        have = packet["profibus_dp." + name.replace("__", ".")]
        assert have == value, f"packet {number}, {name}: {have!r}, expected {value!r}\n{packet}"


def names(*fields):
    return ["profibus_dp." + f for f in fields]


def test_tshark_is_there():
    assert TSHARK, "tshark is missing: make setup"


def test_the_file_is_pcapng_as_written_down():
    """pcapng draft: section header, interface with if_tsresol 9, enhanced packets, all of whole words."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus.pcapng"
        subprocess.run([str(MON), "-q", "-w", str(path), "-"], input=b"# rate 500000\n5.000000007 E5\n", cwd=TOP, timeout=30)
        data, at, blocks = path.read_bytes(), 0, []
        while at < len(data):
            kind, length = struct.unpack_from("<II", data, at)
            assert struct.unpack_from("<I", data, at + length - 4)[0] == length
            blocks.append((kind, data[at + 8:at + length - 4]))
            at += length
    assert [b[0] for b in blocks] == [0x0A0D0D0A, 1, 6]
    assert blocks[0][1][:8] == struct.pack("<IHH", 0x1A2B3C4D, 1, 0)
    assert blocks[1][1] == struct.pack("<HHI", 147, 0, 0) + struct.pack("<HHB3xHH", 9, 1, 9, 0, 0)
    interface, high, low, have, length = struct.unpack_from("<IIIII", blocks[2][1])
    assert (interface, high << 32 | low, have, length) == (0, 5000000007, 9, 9)
    assert blocks[2][1][20:29] == bytes((1, 0, 0, 0)) + struct.pack(">I", 500000) + b"\xe5"


def test_telegram_and_services_of_the_et200s_trace():
    packets = tshark((TOP / "host_tests/records/et200s.rec").read_text(), *names(
        "sd", "le", "da", "sa", "dsap", "ssap", "fc", "fc.request", "fc.fcb", "fc.fcv", "service", "fcs", "ed", "rate",
        "prm.lock", "prm.sync", "prm.freeze", "prm.wd_on", "prm.wd_ms", "prm.min_t_sdr", "prm.ident", "prm.group",
        "prm.user", "diag.not_ready", "diag.prm_req", "diag.stat_diag", "diag.wd_on", "diag.master", "diag.ident",
        "diag.identifier", "diag.device", "cfg.identifier", "cfg.inputs", "cfg.outputs", "gc.command", "gc.group", "t_sdr",
        "response_to", "response_in"))
    assert len(packets) == 22
    dp(packets, 1, sd="0x68", le="7", da="127", sa="1", dsap="58", ssap="62", fc="0x46", service="Global_Control",
       gc__command="0x00", gc__group="0x00", rate="500000", response_in="")
    dp(packets, 2, da="8", sa="1", dsap="60", ssap="62", fc="0x6d", fc__request="1", fc__fcb="1", fc__fcv="0",
       service="Slave_Diag", fcs="0xf0", ed="0x16", response_in="3")
    dp(packets, 3, da="1", sa="8", dsap="62", ssap="60", fc="0x08", fc__request="0", diag__not_ready="1", diag__prm_req="1",
       diag__stat_diag="0", diag__master="255", diag__ident="0x80e0", response_to="2", t_sdr="15")
    dp(packets, 5, service="Get_Cfg", cfg__identifier="00;10;10", cfg__inputs="2", cfg__outputs="0", response_to="4")
    # B8 = lock, sync, freeze, watchdog; 0D * 0F * 10 ms
    dp(packets, 6, le="37", service="Set_Prm", prm__lock="2", prm__sync="1", prm__freeze="1", prm__wd_on="1",
       prm__wd_ms="1950", prm__min_t_sdr="11", prm__ident="0x80e0", prm__group="0x00",
       prm__user="c0000011210000000000000100000000000000002001001818", response_in="7")
    dp(packets, 7, sd="0xe5", service="Set_Prm", response_to="6", t_sdr="15")
    dp(packets, 8, service="Chk_Cfg", cfg__identifier="00;10;10")
    dp(packets, 11, diag__not_ready="0", diag__stat_diag="1", diag__wd_on="1", diag__master="1",
       diag__identifier="49" + "00" * 8, diag__device="1482" + "00" * 18)
    dp(packets, 19, diag__stat_diag="0")


def test_data_exchange_and_special_identifiers():
    body = bytes.fromhex("88 82 7D 3E 3E F3 C4 87 8A 01 02 03 04 4F 43 11")
    cfg = bytes((0x68, len(body), len(body), 0x68)) + body + bytes((sum(body) % 256, 0x16))
    record = ("# rate 500000\n1.0 " + cfg.hex(" ") + "\n"
              "1.001000 68 05 05 68 03 02 7D 01 02 85 16\n1.001270 68 05 05 68 02 03 0A 11 12 32 16\n"
              "1.002000 68 05 05 68 03 02 7D 01 02 85 16\n1.002270 68 05 05 68 02 03 0A 11 12 32 16\n")
    packets = tshark(record, *names("cfg.identifier", "cfg.inputs", "cfg.outputs", "outputs", "inputs", "service", "t_sdr",
                                    "fc.answer_function", "retry"))
    # F3: 8 octets each way; C4 87 8A: 8 out, 11 in; 4F 43: 4 words in; 11: 2 in
    dp(packets, 1, cfg__identifier="f3;c4878a01020304;4f43;11", cfg__inputs="29", cfg__outputs="16")
    dp(packets, 2, outputs="0102", service="Data_Exchange", retry="")
    dp(packets, 3, inputs="1112", service="Data_Exchange", fc__answer_function="10", t_sdr="14")
    dp(packets, 4, retry="1")


def test_what_is_wrong_is_flagged():
    packets = tshark(WRONG, *names("bad_fcs", "bad_le", "bad_octets", "bad_telegram", "refused", "unasked", "fcs", "wrong",
                                   "response_to"), "_ws.expert.message", "_ws.col.Info")
    assert len(packets) == 9
    assert packets[0]["_ws.expert.message"] == "FCS is F2, right is F1" and packets[0]["profibus_dp.wrong"] == "1"
    assert packets[1]["_ws.expert.message"] == "LE 05 is not LEr 06"
    assert packets[2]["_ws.expert.message"] == "Parity, framing or a gap"
    assert packets[4]["_ws.expert.message"] == "RS, SAP not activated" and packets[4]["profibus_dp.response_to"] == "4"
    # an answer 1000 us after its request belongs to it, whoever is late; the next one to nothing
    assert packets[6]["profibus_dp.response_to"] == "6"
    assert packets[7]["_ws.expert.message"] == "Answer that nobody asked for"
    assert "octets, LE announces 13" in packets[8]["_ws.expert.message"], packets[8]


def test_random_octets_do_not_stop_it():
    import random
    source = random.Random(11)
    lines = ["# rate 500000"]
    for i in range(1500 if os.environ.get("TEST_FULL") else 200):
        body = source.randbytes(source.randrange(4, 30))
        octets = bytes((0x68, len(body), len(body), 0x68)) + body + bytes((sum(body) % 256, 0x16))
        if source.randrange(3) == 0:
            octets = source.randbytes(source.randrange(1, 30))
        lines.append(f"1.{i:06} {octets.hex(' ')}".replace("1.", f"{1 + i}."))
    packets = tshark("\n".join(lines) + "\n", "frame.number", "_ws.lua.error", "_ws.col.Info")
    assert len(packets) >= 200 and not any(p["_ws.lua.error"] for p in packets), packets[:3]


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), __file__))
