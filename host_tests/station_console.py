#!/usr/bin/env python3
"""The console of fieldling-dp: one line in, one line of key=value pairs out, nothing changed by what is wrong."""
import re
import sys

from raw_master import DIAG_FIRST, STATUS, Exchange, RawMaster, bring_up
from station import Station, expect, run_tests

AT_8 = ("fieldling-dp", "--address", "8", "--baud", "500000")


def test_status_says_everything():
    with Station(*AT_8) as station:
        status = station.ask("status")
        for key, value in {"state": "WAIT_PRM", "address": "8", "master": "none", "groups": "00", "ident": "1234",
                           "sync_supported": "1", "freeze_supported": "1", "sync": "0", "freeze": "0", "wd": "off",
                           "wd_ms": "0", "wd_state": "BAUD_CONTROL", "baud": "500000", "min_t_sdr": "11",
                           "not_ready": "1", "in": "1F00", "out": "0000"}.items():
            expect(key, status[key], value)
        for key in ("sd_count sd_error_count parity overrun gap format checksum foreign requests retries answers cancelled "
                    "refused data_exchange global_control wrong_length prm_rejected cfg_rejected not_processed "
                    "wd_expired faults").split():
            expect(key, status[key], "0")


def test_status_follows_the_station():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        bring_up(master)
        exchange = Exchange(master)
        for n in range(5):
            exchange(n, 0xA5)
        status = station.ask("status")
        for key, value in {"state": "DATA_EXCH", "master": "2", "not_ready": "0", "data_exchange": "5",
                           "out": "04A5"}.items():
            expect(key, status[key], value)
        expect("requests are counted", int(status["requests"]) >= 9, True)
        expect("out", station.ask("out"), {"out": "04A5"})


def test_in_sets_what_the_master_reads():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        bring_up(master)
        exchange = Exchange(master)
        exchange(1, 2, "1F 00")
        expect("in 1", station.ask("in 1 34"), {"in": "1", "value": "34"})
        expect("in 3", station.ask("in 3 0xFF"), {"in": "3", "value": "255"})
        station.ask("status")  # one more turn of the main loop: the inputs are with the stack
        exchange(3, 4, "22 FF")


def test_diag_is_told_to_the_master():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        expect("diag", station.ask("diag 0307AB"), {"diag": "0307AB"})
        station.ask("status")
        # Slave_Diag octet 1: 02 Station_Not_Ready + 08 Ext_Diag
        master.ask(DIAG_FIRST, "68 0E 0E 68 82 88 08 3E 3C 0A 05 00 FF 12 34 03 07 AB 95 16")
        expect("clear", station.ask("diag clear"), {"diag": "none"})
        station.ask("status")
        master.ask(DIAG_FIRST, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16")


def test_wrong_lines_are_answered_error_and_change_nothing():
    with Station(*AT_8) as station:
        before = station.ask("status")
        for line, reason in {
            "": "empty-line", "   \t ": "empty-line", "help me": "unknown-command", "STATUS": "unknown-command",
            "status now": "no-argument-expected", "out 1": "no-argument-expected", "quit now": "no-argument-expected",
            "in": "usage-in-module-value", "in 1": "usage-in-module-value", "in 1 2 3": "usage-in-module-value",
            "in 0 1": "no-such-input-module", "in 2 1": "no-such-input-module", "in 4 1": "no-such-input-module",
            "in 5 1": "no-such-input-module", "in -1 1": "no-such-input-module", "in x 1": "no-such-input-module",
            "in 1 256": "value-is-0-to-255", "in 1 -1": "value-is-0-to-255", "in 1 1x": "value-is-0-to-255",
            "diag": "usage-diag-hex-or-clear", "diag 02 01": "usage-diag-hex-or-clear",
            "diag 020": "not-hexadecimal-octets", "diag 02zz": "not-hexadecimal-octets",
            "diag " + "02" * 300: "not-hexadecimal-octets", "diag 05": "not-whole-diagnosis-blocks",
            "diag 00": "not-whole-diagnosis-blocks", "trace": "usage-trace-on-or-off",
            "trace maybe": "usage-trace-on-or-off", "trace on off": "usage-trace-on-or-off",
            "status\0": "not-text", "in 1 \x01": "not-text", "st\ratus": "not-text", "in 1 \x7f": "not-text",
            "x" * 1025: "line-too-long", "in 1 33" + " " * 100000: "line-too-long", "a " * 200: "too-many-words",
        }.items():
            expect(f"answer to {line[:40]!r}", station.ask(line)["error"], reason)
        expect("status", station.ask("status"), before)


def test_every_way_to_end_a_line_is_one_line():
    with Station(*AT_8) as station:
        expect("CR LF", station.ask("out\r"), {"out": "0000"})
        station.process.stdin.write("out\nin 1 32\nin 1 33\nout")  # three lines and a half
        station.process.stdin.flush()
        answers = [station.ask("") for _ in range(1)]  # ends the half line
        answers += [dict(pair.split("=", 1) for pair in station._answers.get(timeout=10).split()) for _ in range(3)]
        expect("answers", answers, [{"out": "0000"}, {"in": "1", "value": "32"}, {"in": "1", "value": "33"},
                                    {"out": "0000"}])


def test_trace_shows_each_telegram_layer_by_layer():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        master.ask(*STATUS)
        expect("on", station.ask("trace on"), {"trace": "on"})
        master.ask(*STATUS)
        bring_up(master)
        Exchange(master)(1, 2)
        master.no_answer("68 05 05 68 09 02 7D 01 02 8B 16")  # for station 9
        master.no_answer("DC 02 02")
        # Ident
        master.ask("10 08 02 4E 58 16", "68 21 21 68 02 08 08 09 09 04 04 46 69 65 6C 64 6C 69 6E 67 44 50 2D 54 45 53 54 "
                   "30 31 56 31 2E 30 56 30 2E 31 E6 16")
        master.no_answer("10 08 02 49 54 16")  # wrong FCS
        station.wait(lambda: any("fdl=invalid" in line for line in station.traces), "the trace")
        expect("off", station.ask("trace off"), {"trace": "off"})
        seen = len(station.traces)
        master.ask(*STATUS)
        station.ask("status")
        expect("no trace when off", len(station.traces), seen)
        text = "\n".join(re.sub(r" t=\d+\.\d{6} ", " ", line) for line in station.traces)
        for line in (
            "trace=rx phy=100802495316 fdl=FDL_STATUS da=8 sa=2 fcb=0 fcv=0 len=0 ddlm=none state=WAIT_PRM",
            "trace=tx phy=100208000A16 fdl=OK da=2 sa=8 len=0 ddlm=none state=WAIT_PRM",
            "trace=rx phy=6805056888826D3C3EF116 fdl=SRD_HIGH da=8.60 sa=2.62 fcb=1 fcv=0 len=0 ddlm=Slave_Diag.req "
            "state=WAIT_PRM",
            "trace=rx phy=680C0C6888825D3D3E8000000B123400B316 fdl=SRD_HIGH da=8.61 sa=2.62 fcb=0 fcv=1 len=7 "
            "ddlm=Set_Prm.req state=WAIT_CFG",
            "trace=tx phy=E5 fdl=SC ddlm=none state=WAIT_CFG",
            "trace=rx phy=6809096888827D3E3E102010206316 fdl=SRD_HIGH da=8.62 sa=2.62 fcb=1 fcv=1 len=4 "
            "ddlm=Chk_Cfg.req state=DATA_EXCH",
            "trace=rx phy=6805056808027D01028A16 fdl=SRD_HIGH da=8 sa=2 fcb=1 fcv=1 len=2 ddlm=Data_Exchange.req "
            "state=DATA_EXCH",
            "trace=tx phy=680505680208081F003116 fdl=DL da=2 sa=8 len=2 ddlm=Data_Exchange.res state=DATA_EXCH",
            "trace=rx phy=6805056809027D01028B16 fdl=SRD_HIGH da=9 sa=2 fcb=1 fcv=1 len=2 ddlm=Data_Exchange.req "
            "state=DATA_EXCH",
            "trace=rx phy=DC0202 fdl=TOKEN da=2 sa=2 ddlm=none state=DATA_EXCH",
            "fdl=DL da=2 sa=8 len=30 ddlm=none state=DATA_EXCH",
            "trace=rx phy=100802495416 fdl=invalid state=DATA_EXCH",
        ):
            expect(f"{line} is there", line in text, True)


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
