#!/usr/bin/env python3
"""The analyzer against expectations worked out by hand from the standard's tables, not from its own output."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import scripted

TOP = Path(__file__).resolve().parent.parent
MON = Path(os.environ.get("FIELDLING_BIN", "build/posix")) / "fieldling-mon"
RECORDS = TOP / "host_tests/records"


def mon(*arguments, record=None, status=None):
    """-> lines of output."""
    result = subprocess.run([str(MON), *map(str, arguments)], input=(record or "").encode(), cwd=TOP, timeout=30,
                            capture_output=True, env=dict(os.environ, TZ="UTC"))
    if status is not None:
        assert result.returncode == status, f"exit {result.returncode}\n{result.stdout.decode()}{result.stderr.decode()}"
    return result.stdout.decode().splitlines() + result.stderr.decode().splitlines()


def one(octets, *arguments, record_rate=500000):
    """The command line of one telegram, without number and time."""
    lines = mon(*arguments, "-", record=f"# rate {record_rate}\n1.0 {octets}\n")
    return lines[0].split(" ", 2)[2]


def words(lines):
    """Detail lines with their blanks squeezed."""
    return [" ".join(line.split()) for line in lines]


def expect(lines, *wanted):
    have = words(lines)
    for line in wanted:
        assert line in have, f"{line!r} is not in\n" + "\n".join(have)


# ---- the two views (spec A11) -----------------------------------------------------------------------------------

def test_the_documents_own_lines():
    # 15:28:46.828821 UTC of a day after 2001; the document prints FCS as 00, right is 90+80+6D+3C+3E = F7
    start = 1700000000 - 1700000000 % 86400 + 15 * 3600 + 28 * 60 + 46
    record = f"# rate 500000\n{start}.828821 68 05 05 68 90 80 6D 3C 3E F7 16\n"
    assert mon("--view", "both", "-", record=record, status=0) == [
        "000000 15:28:46.828821 0 0.62 -> 16.60 DP req. Slave Diag",
        "000000 15:28:46.828821 0 68 05 05 68 90 80 6d 3c 3e f7 16",
    ]


def test_the_documents_trace():
    lines = mon(RECORDS / "document.rec", status=1)
    assert [line.split(" ", 2)[2] for line in lines] == [
        "0 0.62 -> 16.60 DP req. Slave Diag",
        "0 16.60 -> 0.62 DP res. Slave Diag",
        "0 0.62 -> 16.61 DP req. Set Prm",
        "0 (16 -> 0) FDL res. short acknowledge of Set Prm",
        "0 0.62 -> 16.62 DP req. Chk Cfg",
        "0 (16 -> 0) FDL res. short acknowledge of Chk Cfg",
        "0 0.62 -> 127.58 DP req. Global Control",
        "0 0 -> 16 DP req. Data Exchange",
        "0 16 -> 0 DP res. Data Exchange",
        "0 9.60 -> 3.61 DP req. Set Prm",
        "0 (3 -> 9) FDL res. short acknowledge of Set Prm",
        "0 9 -> 8 FDL res. unknown answer function",
        "1 wrong: FCS is 88, right is BE",
    ]


def test_each_kind_of_telegram():
    assert one("10 08 02 49 53 16") == "0 2 -> 8 FDL req. FDL Status"
    assert one("DC 03 02") == "0 2 -> 3 FDL token"
    assert one("E5") == "0 FDL res. short acknowledge, nobody asked"
    assert one("10 02 08 03 0D 16") == "0 8 -> 2 FDL res. RS, SAP not activated"
    assert one("10 08 02 4E 58 16") == "0 2 -> 8 FDL req. Ident"
    assert one("10 08 02 4F 59 16") == "0 2 -> 8 FDL req. LSAP Status"
    # 08 + 02 + 7D + 42 + 24 + 00 + 01 + 02 + 03 + 04 + 05 = FC
    assert one("A2 08 02 7D 42 24 00 01 02 03 04 05 FC 16") == "0 2 -> 8 DP req. Data Exchange"
    assert one("68 05 05 68 88 82 5D 38 3E DD 16") == "0 2.62 -> 8.56 DP req. RD Inp"
    assert one("68 05 05 68 88 82 5D 39 3E DE 16") == "0 2.62 -> 8.57 DP req. RD Outp"
    assert one("68 09 09 68 FE 82 5D 37 3E 05 12 34 00 9D 16") == "0 2.62 -> 126.55 DP req. Set Slave Add"


def test_wrong_telegrams_are_shown_as_what_they_are():
    assert one("68 05 06 68 88 82 6D 3C 3E F1 16") == "1 wrong: LE 05 is not LEr 06"
    assert one("68 03 03 68 08 02 49 53 16") == "1 wrong: LE is 3, allowed is 4 to 249"
    assert one("68 FA FA 68 08 02 49 53 16") == "1 wrong: LE is 250, allowed is 4 to 249"
    assert one("68 05 05 10 88 82 6D 3C 3E F1 16") == "1 wrong: second SD is 10, not 68"
    assert one("68 05 05 68 88 82 6D 3C 3E F2 16") == "1 wrong: FCS is F2, right is F1"
    assert one("68 05 05 68 88 82 6D 3C 3E F1 17") == "1 wrong: end delimiter is 17, not 16"
    assert one("68 05 05 68 88 82 6D") == "1 wrong: cut short: 7 of 11 octets"
    assert one("10 08 02! 49 53 16") == "1 wrong: parity error in octet 3"
    assert one("10 08 02 49? 53 16") == "1 wrong: framing error in octet 4"
    assert one("55 AA") == "1 wrong: 55 is no start delimiter"
    # DA 88 announces a SAP, LE 4: DA SA FC and one octet for two SAPs: 88+82+6D+3C = B3
    assert one("68 04 04 68 88 82 6D 3C B3 16") == "1 wrong: no room for the SAPs that the addresses announce"


def test_idle_inside_a_telegram_is_told():
    # 500 kbit/s: 2 us a bit. Three octets end after 66 us; the fourth begins 40 T_bit = 80 us later than it may: T_SYN
    # has passed, so these are two wrong telegrams. With 20 T_bit it is one.
    lines = mon("-", record="# rate 500000\n1.0 10 08 02\n1.000106 49 53 16\n", status=1)
    assert [line.split(" ", 2)[2] for line in lines] == ["1 wrong: idle of 20 T_bit before octet 4"]
    lines = mon("-", record="# rate 500000\n1.0 10 08 02\n1.000146 49 53 16\n", status=1)
    assert [line.split(" ", 2)[2] for line in lines] == ["1 wrong: cut short: 3 of 6 octets",
                                                          "1 wrong: 49 is no start delimiter"]


def test_a_good_telegram_is_found_behind_noise():
    lines = mon("-", record="1.0 FF 00 10 08 02 49 53 16\n", status=1)
    assert [line.split(" ", 2)[2] for line in lines] == ["1 wrong: FF is no start delimiter", "0 2 -> 8 FDL req. FDL Status"]


def test_back_to_back_telegrams_of_a_pty_are_told_apart():
    lines = mon("-", record="1.0 10 08 02 49 53 16 10 02 08 00 0A 16 DC 02 02 E5\n", status=0)
    assert [line.split(" ", 2)[2] for line in lines] == [
        "0 2 -> 8 FDL req. FDL Status", "0 8 -> 2 FDL res. FDL Status, OK, slave", "0 2 -> 2 FDL token",
        "0 FDL res. short acknowledge, nobody asked"]


def test_a_damaged_telegram_ends_at_a_pause_shorter_than_t_syn():
    # three octets end after 66 us; E5 comes 25 T_bit = 50 us later
    lines = mon("-", record="# rate 500000\n1.0 10 02 08\n1.000116 E5\n", status=1)
    assert [line.split(" ", 2)[2] for line in lines] == ["1 wrong: cut short: 3 of 6 octets",
                                                          "0 FDL res. short acknowledge, nobody asked"]


def test_the_answer_of_another_station_belongs_to_nothing():
    # 2 asks 3, 5 answers: 02 + 05 + 03 = 0A; then 3 answers master 1: 01 + 03 + 03 = 07
    record = "1.0 68 05 05 68 03 02 7D 01 02 85 16\n1.001 10 02 05 03 0A 16\n1.002 10 01 03 03 07 16\n"
    lines = mon("-", record="# rate 500000\n" + record, status=0)
    assert [line.split(" ", 3)[3] for line in lines[1:]] == ["5 -> 2 FDL res. RS, SAP not activated",
                                                              "3 -> 1 FDL res. RS, SAP not activated"]


def test_the_reserved_bit_of_fc_is_told():
    assert one("10 08 02 C9 D3 16") == "0 2 -> 8 FDL req. FDL Status, FC bit 7 set"


# ---- content --------------------------------------------------------------------------------------------------------

def test_et200s_field_by_field():
    """Facts 3.10; Set_Prm B8 0D 0F 0B 80E0 00 C0: 1011 1000, 13 * 15 * 10 ms; Slave_Diag 0E = 0000 1110."""
    lines = mon("-v", RECORDS / "et200s.rec", status=0)
    telegrams, last = [], None
    for line in lines:
        if line.startswith(" "):
            last.append(" ".join(line.split()))
        else:
            last = [line.split(" ", 3)[3]]
            telegrams.append(last)
    operate = ["1.62 -> 127.58 DP req. Global Control", "FC 46 request, FCB 0, FCV 0", "Control_Command 00",
               "meaning Operate", "Group_Select 00, all slaves"]

    def diag_request(fc, fcb, fcv):
        return ["1.62 -> 8.60 DP req. Slave Diag", f"FC {fc} request, FCB {fcb}, FCV {fcv}"]

    def diag_answer(status_2, *blocks):
        return ["8.60 -> 1.62 DP res. Slave Diag", "FC 08 answer, DL, data", "T_SDR 15 T_bit",
                *status_2, "Station_status_3 00", *blocks]

    configuration = ["identifier 00 empty slot", "identifier 10 1 byte in", "identifier 10 1 byte in"]
    extended = ["Master_Add 1", "Ident_Number 80E0H", "identifier related modules none",
                "device related 82" + " 00" * 18, "module status slot 0, specifier 0"]
    starting = diag_answer(["Station_status_1 00", "Station_status_2 0E WD_On always-1 Stat_Diag"], *extended)
    ready = diag_answer(["Station_status_1 00", "Station_status_2 0C WD_On always-1"], *extended)
    expected = [
        operate,
        diag_request("6D", 1, 0),
        diag_answer(["Station_status_1 02 Station_Not_Ready", "Station_status_2 05 always-1 Prm_Req"],
                    "Master_Add none", "Ident_Number 80E0H"),
        ["1.62 -> 8.59 DP req. Get Cfg", "FC 5D request, FCB 0, FCV 1"],
        ["8.59 -> 1.62 DP res. Get Cfg", "FC 08 answer, DL, data", "T_SDR 15 T_bit", *configuration],
        ["1.62 -> 8.61 DP req. Set Prm", "FC 7D request, FCB 1, FCV 1",
         "Station_status B8 Lock_Req Sync_Req Freeze_Req WD_On", "lock lock to this master",
         "watchdog 13 x 15 x 10 ms = 1950 ms", "min_T_SDR 11 T_bit", "Ident_Number 80E0H", "Group_Ident 00",
         "user parameters C0 00 00 11 21 00 00 00 00 00 00 01 00 00 00 00 00 00 00 00 20 01 00 18 18",
         "DPV1_Status_1 C0 DPV1_Enable Fail_Safe", "DPV1_Status_2 00", "DPV1_Status_3 00"],
        ["(8 -> 1) FDL res. short acknowledge of Set Prm", "T_SDR 15 T_bit"],
        ["1.62 -> 8.62 DP req. Chk Cfg", "FC 5D request, FCB 0, FCV 1", *configuration],
        ["(8 -> 1) FDL res. short acknowledge of Chk Cfg", "T_SDR 15 T_bit"],
        diag_request("7D", 1, 1), starting, diag_request("5D", 0, 1), starting,
        diag_request("7D", 1, 1), starting, diag_request("5D", 0, 1), starting,
        diag_request("7D", 1, 1), ready,
        operate, operate, operate,
    ]
    for number, (have, want) in enumerate(zip(telegrams, expected)):
        assert have == want, f"telegram {number}:\n{have}\n{want}"
    assert len(telegrams) == len(expected)


def test_diagnosis_in_words():
    # facts 3.9: identifier block 44 00 01 00 = module 8; channel 88 41 21: module 8, input channel 1, bit, short
    # circuit; device block 04 10 20 30. Status 1 7E: all but Station_Non_Existent and Master_Lock.
    du = "7E BF 80 03 12 34 44 00 01 00 88 41 21 04 10 20 30"
    body = bytes.fromhex("82 88 08 3E 3C" + du)
    octets = bytes((0x68, len(body), len(body), 0x68)) + body + bytes((sum(body) % 256, 0x16))
    lines = mon("-v", "-", record="1.0 " + octets.hex(" ") + "\n", status=0)
    expect(lines,
           "Station_status_1 7E Prm_Fault Invalid_Slave_Response Not_Supported Ext_Diag Cfg_Fault Station_Not_Ready",
           "Station_status_2 BF Deactivated Sync_Mode Freeze_Mode WD_On always-1 Stat_Diag Prm_Req",
           "Station_status_3 80 Ext_Diag_Overflow", "Master_Add 3", "Ident_Number 1234H",
           "identifier related modules 8", "channel related module 8 input channel 1, bit: short circuit (1)",
           "device related 10 20 30")


def test_identifier_bytes_in_words():
    # facts 3.8: F3 four words both whole; C4 87 8A + 4 octets of the maker: 8 bytes out, 11 in, whole; 4F 43: maker 15 = none
    body = bytes.fromhex("88 82 7D 3E 3E F3 C4 87 8A 01 02 03 04 00 4F 43 11")
    octets = bytes((0x68, len(body), len(body), 0x68)) + body + bytes((sum(body) % 256, 0x16))
    lines = mon("-v", "-", record="1.0 " + octets.hex(" ") + "\n", status=0)
    expect(lines, "identifier F3 4 words in and out, consistent as a whole",
           "identifier C4 8 bytes out, consistent as a whole, 11 bytes in, consistent as a whole, maker's octets follow",
           "maker's octets 01 02 03 04", "identifier 00 empty slot", "identifier 4F 4 words in",
           "identifier 11 2 bytes in")


def test_control_commands_and_parameters_in_words():
    # Sync 20 + Unfreeze 04, group 05; 88 + 82 -> SDN high 46: FF+82+46+3A+3E+24+05 = 68
    expect(mon("-v", "-", record="1.0 68 07 07 68 FF 82 46 3A 3E 24 05 68 16\n", status=0),
           "Control_Command 24 Sync Unfreeze", "Group_Select 05")
    # Unlock, no watchdog, min_Tsdr 0
    body = bytes.fromhex("88 82 5D 3D 3E 40 00 00 00 12 34 00")
    octets = bytes((0x68, 12, 12, 0x68)) + body + bytes((sum(body) % 256, 0x16))
    expect(mon("-v", "-", record="1.0 " + octets.hex(" ") + "\n", status=0), "Station_status 40 Unlock_Req",
           "lock unlock for other masters", "watchdog off", "min_T_SDR unchanged")
    # DPV1_Status_1 84: DP-V1 and the time base of 1 ms
    body = bytes.fromhex("88 82 5D 3D 3E 88 14 02 0B 12 34 00 84 00 00")
    octets = bytes((0x68, 15, 15, 0x68)) + body + bytes((sum(body) % 256, 0x16))
    expect(mon("-v", "-", record="1.0 " + octets.hex(" ") + "\n", status=0), "watchdog 20 x 2 x 1 ms = 40 ms",
           "DPV1_Status_1 84 DPV1_Enable WD_Base_1ms")
    expect(mon("-v", "-", record="1.0 68 09 09 68 FE 82 5D 37 3E 05 12 34 01 9E 16\n", status=0),
           "New_Slave_Add 5", "Ident_Number 1234H", "No_Add_Chg yes")


# ---- pairing, summary, plot -----------------------------------------------------------------------------------------

EXCHANGE = """# rate 500000
1.000000 68 05 05 68 03 02 7D 01 02 85 16
1.000270 68 05 05 68 02 03 08 11 12 30 16
1.001000 68 05 05 68 03 02 5D 03 04 69 16
1.002000 68 05 05 68 03 02 5D 03 04 69 16
1.002264 68 05 05 68 02 03 08 11 12 30 16
1.003000 68 05 05 68 03 02 7D 05 06 8D 16
1.003282 10 02 03 03 08 16
"""


def test_a_lost_answer_a_retry_and_a_refusal():
    """11 octets of 22 us: the first request ends at 1.000242; the answer comes 28 us = 14 T_bit later, the third answer
    22 us = 11, the refusal 40 us = 20."""
    lines = mon("-v", "-", record=EXCHANGE, status=0)
    expect(lines, "000003 00:00:01.002000 0 2 -> 3 DP req. Data Exchange (retry)",
           "000006 00:00:01.003282 0 3 -> 2 FDL res. RS, SAP not activated to Data Exchange",
           "T_SDR 14 T_bit", "T_SDR 11 T_bit", "T_SDR 20 T_bit")


def test_what_is_a_retry():
    """With FCV: the same octets, answered before or not (facts 3.3). Without FCV, a first request: only when unanswered."""
    answer = "10 02 03 00 05 16"
    for request, between, retry in (("10 03 02 7D 82 16", answer, True), ("10 03 02 7D 82 16", None, True),
                                    ("10 03 02 6D 72 16", answer, False), ("10 03 02 6D 72 16", None, True)):
        telegrams = [request] + [between] * bool(between) + [request]
        record = "".join(f"1.{i:03} {t}\n" for i, t in enumerate(telegrams))
        lines = mon("-", record="# rate 500000\n" + record, status=0)
        assert lines[-1].endswith(" (retry)") == retry, (request, between, lines)


def test_the_summary_counts():
    lines = words(mon("-q", "--summary", "-", record=EXCHANGE, status=0))
    # 6 telegrams of 11 octets and one of 6: 72 octets * 22 us = 1.584 ms of 3.414 ms
    assert lines[0] == ("7 telegrams in 0.003414 s at 500000 bit/s, line busy 46.4 %, 0 requests without T_SYN; "
                        "0 wrong, 0 tokens"), lines[0]
    # cycles: 1.000 -> 1.001 -> (retry not counted) -> 1.003
    assert lines[2] == "3 4 3 0 1 1 1 11.00/ 14.00/ 20.00 1.00/ 2.00/ 2.00", lines[2]


def test_a_request_without_t_syn_is_counted():
    # the token ends 66 us after 1.0; the next begins 60 us = 30 T_bit later: less than 33
    lines = mon("-q", "--summary", "-", record="# rate 500000\n1.0 DC 02 02\n1.000126 10 03 02 49 4E 16\n", status=0)
    assert "1 requests without T_SYN" in lines[0], lines[0]


def test_the_plot_is_a_picture():
    import xml.etree.ElementTree as tree
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bus.svg"
        mon("-q", "--plot", path, "-", record=EXCHANGE, status=0)
        root = tree.parse(path).getroot()
        texts = [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]
        assert "master 2" in texts and "station 3" in texts, texts
        assert "T_SDR of 3 answers [T_bit]" in texts, texts
        # the last cycles: from the first exchange to the last, two requests, a retry and two answers: 5 bars
        colors = [r.get("fill") for r in root.iter("{http://www.w3.org/2000/svg}rect")]
        assert colors.count("#2f6db3") == 3 + 1 and colors.count("#3a9d5d") >= 2 + 1, colors
        mon("-q", "--plot", path, "-", record="# untimed\n1.0 E5\n", status=0)  # nothing takes time
        assert "The last telegrams" in path.read_text()
        mon("-q", "--plot", path, "-", record="", status=0)
        assert "no telegrams" in path.read_text()


def test_a_record_of_a_record_is_the_same():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "again.rec"
        first = mon("--view", "both", "--record", path, RECORDS / "et200s.rec", status=0)
        assert mon("--view", "both", path, status=0) == first


# ---- the other protocols ----------------------------------------------------------------------------------------

def test_pa_octets():
    # facts, section 6
    record = "1.0 10 08 02 49 DC 05\n1.1 DC 02 02 24 46\n1.2 68 05 05 68 88 82 6D 3C 3E E3 47\n1.3 E5 14 26\n1.4 10 08 02 49 DC 06\n"
    lines = mon("--pa", "-", record=record, status=1)
    assert [line.split(" ", 2)[2] for line in lines] == [
        "0 2 -> 8 FDL req. FDL Status", "0 2 -> 2 FDL token", "0 2.62 -> 8.60 DP req. Slave Diag",
        "0 (8 -> 2) FDL res. short acknowledge of Slave Diag", "1 wrong: CRC is DC06, right is DC05"]


def test_modbus_rtu_and_ascii():
    # spec B6: 11 03 00 6B 00 03, CRC 76 87 (Modbus over serial line, appendix B); 0A 01 04 A1 00 01 LRC 4F -> 0A 81 02 LRC 73
    lines = mon("--modbus", "rtu", "--rate", "9600", "-v", "-",
                record="1.0 11 03 00 6B 00 03 76 87\n1.1 11 83 02 C1 34\n1.2 11 83 02 C1 35\n", status=1)
    expect(lines, "000000 00:00:01.000000 0 0 -> 17 MB req. Read Holding Registers", "address 107", "quantity 3",
           "000001 00:00:01.100000 0 17 -> 0 MB res. Read Holding Registers, exception 02, illegal data address",
           "000002 00:00:01.200000 1 wrong: CRC is 35C1, right is 34C1")
    text = ":0A0104A100014F\r\n:0A810273\r\n:0A810274\r\n"
    lines = mon("--modbus", "ascii", "--rate", "9600", "-", record="1.0 " + text.encode().hex(" ") + "\n", status=1)
    assert [line.split(" ", 2)[2] for line in lines] == [
        "0 0 -> 10 MB req. Read Coils", "0 10 -> 0 MB res. Read Coils, exception 02, illegal data address",
        "1 wrong: LRC is 74, right is 73"]


def crc16(octets):
    """Modbus over serial line, 6.2.2, bit by bit; low octet first on the line."""
    crc = 0xFFFF
    for octet in octets:
        crc ^= octet
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return bytes((crc & 255, crc >> 8))


def test_modbus_content():
    """The examples of the application protocol V1.1b3, chapter 6; the answer 20 ms after the end of its request."""
    assert crc16(bytes.fromhex("02 07")) == bytes.fromhex("41 12")  # spec B1

    def details(request, answer):
        lines, at = ["# rate 9600"], 1.0
        for text in (request, answer):
            octets = bytes.fromhex("11" + text)
            octets += crc16(octets)
            lines.append(f"{at:.6f} {octets.hex(' ')}")
            at += len(octets) * 11 / 9600 + 0.020
        return mon("--modbus", "rtu", "-v", "-", record="\n".join(lines) + "\n", status=0)

    expect(details("01 00 13 00 13", "01 03 CD 6B 05"), "address 19", "quantity 19",
           "bits, first on the left 10110011 11010110 10100000", "response time 20.000 ms")
    expect(details("03 00 6B 00 03", "03 06 02 2B 00 00 00 64"), "registers 555 0 100")
    expect(details("05 00 AC FF 00", "05 00 AC FF 00"), "address 172", "coil ON")
    expect(details("06 00 01 00 03", "06 00 01 00 03"), "address 1", "value 3")
    expect(details("0F 00 13 00 0A 02 CD 01", "0F 00 13 00 0A"), "quantity 10", "bits, first on the left 10110011 10000000")
    expect(details("10 00 01 00 02 04 00 0A 01 02", "10 00 01 00 02"), "address 1", "quantity 2", "registers 10 258")
    expect(details("16 00 04 00 F2 00 25", "16 00 04 00 F2 00 25"), "address 4", "and mask 00 F2", "or mask 00 25")
    expect(details("17 00 03 00 06 00 0E 00 03 06 00 FF 00 FF 00 FF", "17 0C 00 FE 0A CD 00 01 00 03 00 0D 00 FF"),
           "read address 3", "read quantity 6", "write address 14", "registers 255 255 255", "registers 254 2765 1 3 13 255")
    expect(details("08 00 00 A5 37", "08 00 00 A5 37"), "sub-function 0", "data A5 37")
    expect(details("2B 0E 01 00", "2B 0E 01 01 00 00 01 00 02 41 42"), "data 0E 01 00")


def fcs16(octets):
    """ISO/IEC 13239, the 16-bit FCS, bit by bit; low octet first on the line."""
    crc = 0xFFFF
    for octet in octets:
        for bit in range(8):
            crc = crc >> 1 ^ (0x8408 if (crc ^ octet >> bit) & 1 else 0)
    crc ^= 0xFFFF
    return bytes((crc & 255, crc >> 8))


def test_hdlc():
    assert fcs16(b"123456789") == bytes.fromhex("6E 90")  # the catalogue's check value 906E
    frames = [bytes.fromhex(h) for h in ("03 08 01 05", "03 09 01 05 31", "03 93")]
    record = "".join(f"{i + 1}.0 {(f + fcs16(f)).hex(' ')}\n" for i, f in enumerate(frames))
    lines = mon("--hdlc", "--rate", "7200", "-v", "-", record=record + "5.0 03 93 00 00\n", status=1)
    expect(lines, "000000 00:00:01.000000 0 0 -> 03 RM req. Request data channel 05",
           "000001 00:00:02.000000 0 03 -> 0 RM res. Request data channel 05", "digital ON",
           "000002 00:00:03.000000 0 03 HDLC SNRM, P/F")
    assert "1 wrong: FCS is 0000" in lines[-1], lines[-1]


# ---- a line, live -------------------------------------------------------------------------------------------------

def test_a_live_line_and_its_error_marks():
    """A pty: what is written to one end is heard at the other. Linux marks a good FF as FF FF where errors are marked, on
    a pty too; a damaged octet, FF 00 X, cannot be made there."""
    import pty
    import time
    import tty
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    process = subprocess.Popen([str(MON), "--view", "both", os.ttyname(theirs)], stdout=subprocess.PIPE, cwd=TOP)
    try:
        lines = []
        for octets in ("10 08 02 49 53 16", "68 05 05 68 FF 82 44 3A FF FE 16", "DC 02 02"):
            for _ in range(200):  # until it has opened the line: what came before is gone
                os.write(ours, bytes.fromhex(octets))
                time.sleep(0.05)
                os.set_blocking(process.stdout.fileno(), False)
                text = process.stdout.read()
                if text:
                    lines += [" ".join(line.split()[2:]) for line in text.decode().splitlines()]
                    break
        process.terminate()
        process.wait(10)
    finally:
        process.kill()
        os.close(ours)
        os.close(theirs)
    assert "0 2 -> 8 FDL req. FDL Status" in lines and "0 10 08 02 49 53 16" in lines, lines
    # DA FF: everybody, with DSAP 3A and SSAP FF; FF + 82 + 44 + 3A + FF = 2FE
    assert "0 68 05 05 68 ff 82 44 3a ff fe 16" in lines, lines
    assert "0 2 -> 2 FDL token" in lines, lines


# ---- usage --------------------------------------------------------------------------------------------------------

def test_the_readmes_sample_is_what_is_printed():
    text = (TOP / "sim/README.md").read_text()
    block = text.split("$ build/posix/fieldling-mon ", 1)[1].split("```", 1)[0].splitlines()
    lines, at = mon(*block[0].split()), 0
    for line in block[1:]:
        if line != "...":
            assert line in lines[at:], f"{line!r} is not printed, or not in this order"
            at = lines.index(line, at) + 1
    assert at > 20


def test_what_cannot_be_used_is_status_2():
    assert "no such choice" in mon("--view", "x", "-", status=2)[0]
    assert "No such file" in mon("no/such.rec", status=2)[0]
    assert "line 2 is no record line" in mon("-", record="1.0 E5\nhello\n", status=2)[-1]
    assert "a number is expected" in mon("--rate", "fast", "-", status=2)[0]
    mon(status=2)


def test_random_octets_never_stop_it():
    import random
    source = random.Random(5)
    good = bytes.fromhex("68 05 05 68 88 82 6D 3C 3E F1 16")
    for protocol in ([], ["--pa"], ["--modbus", "rtu"], ["--modbus", "ascii"], ["--hdlc"]):
        lines = []
        for i in range(3000 if os.environ.get("TEST_FULL") else 300):
            octets = bytearray(good if source.randrange(3) else source.randbytes(source.randrange(1, 40)))
            octets[source.randrange(len(octets))] = source.randrange(256)
            if source.randrange(4) == 0 and octets[0] == 0x68 and len(octets) == 11:  # a right FCS over wrong content
                octets[9] = sum(octets[4:9]) % 256
            lines.append(f"{i // 10}.{i % 10} {octets.hex(' ')}")
        with tempfile.TemporaryDirectory() as folder:
            output = mon(*protocol, "-v", "--summary", "--plot", folder + "/p.svg", "-w", folder + "/p.pcapng", "-",
                         record="\n".join(lines) + "\n")
            assert any("telegrams in" in line for line in output), output[-5:]


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), __file__))
