#!/usr/bin/env python3
"""fieldling-dp on its line: octets in lumps and pieces, masters that come, go and start over, an address set by a
master, and the serial port's side of the program on a pseudo terminal pair."""
import os
import subprocess
import sys
import tempfile
import termios
import time

from raw_master import DIAG_FIRST, DIAG_NEW, STATUS, Exchange, RawMaster, bring_up, octets
from station import PATIENCE, Station, expect, run_tests

AT_8 = ("fieldling-dp", "--address", "8", "--baud", "500000")
GAP = 0.05  # seconds, ten times the silence that ends a telegram on a pty


def test_a_telegram_in_single_octets_is_one_telegram():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        for _ in range(6):  # a busy machine may tear one apart: a master would ask again, too
            for octet in octets(STATUS[0]):
                os.write(master.fd, bytes([octet]))
            if master.hear() == octets(STATUS[1]):
                return
        raise AssertionError("no answer to a telegram in single octets")


def test_a_telegram_torn_apart_is_dropped_and_the_next_one_answered():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        master.ask(*STATUS)
        master.no_answer("10 08 02")
        master.no_answer("49 53 16")
        expect("gap", station.ask("status")["gap"], "1")
        master.ask(*STATUS)


def test_garbage_before_a_telegram_costs_at_most_this_telegram():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        master.ask(*STATUS)
        for garbage in ("00", "FF FF FF", "AA BB CC DD", "16", "68 05 05", "68 68 68 68", "A2"):
            master.say(garbage + " " + STATUS[0])
            expect(f"after {garbage}", master.hear(GAP) in (b"", octets(STATUS[1])), True)
            time.sleep(GAP)
            master.ask(*STATUS)
        counters = station.ask("status")
        expect("counted", int(counters["sd_error_count"]) + int(counters["format"]) > 0, True)


def test_garbage_behind_a_telegram_keeps_the_line_from_being_answered_into():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        master.ask(*STATUS)
        master.no_answer(STATUS[0] + " 55 AA")
        expect("cancelled", station.ask("status")["cancelled"], "1")
        time.sleep(GAP)
        master.ask(*STATUS)


def test_of_telegrams_in_one_write_the_last_one_is_answered():
    with Station(*AT_8) as station, RawMaster(station.pty) as master:
        bring_up(master)
        exchange = Exchange(master)
        exchange(1, 1)
        # a token, Global_Control "operate", another slave's exchange and its answer, then ours
        master.ask("DC 02 02" "68 07 07 68 FF 82 46 3A 3E 00 00 3F 16" "68 05 05 68 09 02 7D 05 06 93 16"
                   "68 05 05 68 02 09 08 01 02 16 16" "68 05 05 68 08 02 5D 07 08 76 16",
                   "68 05 05 68 02 08 08 1F 00 31 16")
        status = station.ask("status")
        expect("outputs", status["out"], "0708")
        expect("executed", status["data_exchange"], "2")
        expect("foreign", int(status["foreign"]) >= 3, True)
        # a request and its hasty repetition: one answer, executed once
        master.ask("68 05 05 68 08 02 7D 09 0A 9A 16" "68 05 05 68 08 02 7D 09 0A 9A 16",
                   "68 05 05 68 02 08 08 1F 00 31 16")
        expect("no second answer", master.hear(0.1), b"")
        status = station.ask("status")
        expect("outputs", status["out"], "090A")
        expect("executed", status["data_exchange"], "3")


def test_the_station_goes_on_when_the_line_is_closed_and_opened_again():
    with Station(*AT_8) as station:
        with RawMaster(station.pty) as master:
            bring_up(master)
            Exchange(master)(0, 0)
        for n in range(50):
            with RawMaster(station.pty) as master:
                exchange = Exchange(master)
                exchange.fcb = n % 2 == 1
                exchange(n, 1)
        expect("out", station.ask("out"), {"out": "3101"})


def test_a_new_master_gets_no_answer_it_did_not_ask_for():
    with Station(*AT_8) as station:
        for _ in range(50):
            with RawMaster(station.pty) as first:
                first.ask(*STATUS)
                first.say(STATUS[0])  # and goes without reading
                station.ask("out")    # the answer is on the line
            with RawMaster(station.pty) as second:
                station.ask("out")
                expect("unasked octets", second.hear(0), b"")


def test_a_master_that_starts_over_in_the_middle_of_the_exchange():
    with Station(*AT_8) as station:
        with RawMaster(station.pty) as master:
            bring_up(master)
            Exchange(master)(1, 2)
            master.say("68 05 05 68 08 02")  # dies in the middle of a telegram
        with RawMaster(station.pty) as master:
            # Slave_Diag of a station in data exchange: ready, owner 2
            master.wait_for_answer(DIAG_FIRST, "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16")
            master.ask("68 0C 0C 68 88 82 5D 3D 3E 80 00 00 0B 12 34 00 B3 16", "E5")
            master.ask("68 09 09 68 88 82 7D 3E 3E 10 20 10 20 63 16", "E5")
            master.wait_for_answer("68 05 05 68 88 82 5D 3C 3E E1 16",
                                   "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16")
            Exchange(master)(3, 4)
        expect("state", station.ask("status")["state"], "DATA_EXCH")


def test_a_station_that_starts_over_wants_parameters_again():
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(3):
            with Station(*AT_8, "--nv", f"{folder}/nv") as station, RawMaster(station.pty) as master:
                bring_up(master)  # its first answer says Prm_Req
                Exchange(master)(5, 6)
                station.process.kill()
                station.process.wait(PATIENCE)


def test_without_its_master_the_watchdog_takes_the_outputs_back():
    with Station(*AT_8) as station:
        with RawMaster(station.pty) as master:
            master.ask(DIAG_FIRST, DIAG_NEW)
            master.ask("68 0C 0C 68 88 82 5D 3D 3E 88 0A 01 0B 12 34 00 C6 16", "E5")  # watchdog 10 * 1 * 10 ms
            master.ask("68 09 09 68 88 82 7D 3E 3E 10 20 10 20 63 16", "E5")
            master.wait_for_answer("68 05 05 68 88 82 5D 3C 3E E1 16",
                                   "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 12 34 E0 16")
            Exchange(master)(0x11, 0x22)
        station.wait(lambda: station.ask("status")["wd_expired"] == "1", "the watchdog")
        status = station.ask("status")
        expect("state", status["state"], "WAIT_PRM")
        expect("outputs", status["out"], "0000")


def test_an_address_set_by_a_master_is_kept_in_the_nv_file():
    at_126, at_5, at_6 = (("10 7E 02 49 C9 16", "10 02 7E 00 80 16"), ("10 05 02 49 50 16", "10 02 05 00 07 16"),
                          ("10 06 02 49 51 16", "10 02 06 00 08 16"))
    with tempfile.TemporaryDirectory() as folder:
        new = ("fieldling-dp", "--baud", "500000", "--nv", f"{folder}/nv")
        with Station(*new) as station, RawMaster(station.pty) as master:
            master.ask(*at_126)
            master.ask("68 09 09 68 FE 82 6D 37 3E 05 12 34 00 AD 16", "E5")  # to 5, may be changed again
            master.ask(*at_5)
            master.no_answer(at_126[0])
            expect("address", station.ask("status")["address"], "5")
        with Station(*new) as station, RawMaster(station.pty) as master:
            master.ask(*at_5)
            master.ask("68 09 09 68 85 82 6D 37 3E 06 12 34 FF 34 16", "E5")  # to 6, for good
            master.ask(*at_6)
        with Station(*new) as station, RawMaster(station.pty) as master:
            master.ask(*at_6)
            expect("locked", station.ask("status")["address_locked"], "1")
            master.say("68 09 09 68 86 82 6D 37 3E 07 12 34 00 37 16")  # whatever it says, the address stays
            master.hear()
            master.ask(*at_6)
        with Station("fieldling-dp", "--baud", "500000", "--address", "9", "--nv", f"{folder}/nv") as station:
            expect("switches win", station.ask("status")["address"], "9")
        with Station("fieldling-dp", "--baud", "500000") as station:
            expect("without the file", station.ask("status")["address"], "126")


def test_an_address_that_cannot_be_stored_is_not_taken():
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(f"{folder}/gone")
        with Station("fieldling-dp", "--baud", "500000", "--nv", f"{folder}/gone/nv") as station, \
                RawMaster(station.pty) as master:
            os.rmdir(f"{folder}/gone")
            master.ask("68 09 09 68 FE 82 6D 37 3E 05 12 34 00 AD 16", "E5")
            master.ask("10 7E 02 49 C9 16", "10 02 7E 00 80 16")
            status = station.ask("status")
            expect("address", status["address"], "126")
            expect("faults", int(status["faults"]) > 0, True)


# ---- the serial port's side (line_tty.c): one end of a pair is the device, the test holds the other. A pair has no bit
# time and no parity; what a real port adds is checked by nobody here.


class Pair:
    def __init__(self, *arguments):
        self.fd, device = os.openpty()
        name = os.ttyname(device)
        self.process = subprocess.Popen(
            [os.path.join(os.environ.get("FIELDLING_BIN", "build/posix"), "fieldling-dp"), "--line", name, "--address", "8",
             "--baud", "500000", *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.device = device
        end = time.monotonic() + PATIENCE
        while not termios.tcgetattr(device)[0] & termios.PARMRK and time.monotonic() < end:
            time.sleep(0.001)  # until the station has set the port

    def master(self):
        master = RawMaster.__new__(RawMaster)
        master.fd = self.fd
        return master

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()


def test_a_serial_port_carries_every_octet_value():
    with Pair() as pair:
        master = pair.master()
        os.close(pair.device)
        bring_up(master)
        exchange = Exchange(master)
        for n in range(0, 256, 5):
            exchange(n, 0xFF - n)  # FF among them, which PARMRK doubles
        exchange(0xFF, 0xFF)
        exchange(0x00, 0xFF)
        os.close(pair.fd)


def test_a_serial_port_that_goes_away_ends_the_station():
    with Pair() as pair:
        pair.master().ask(*STATUS)
        os.close(pair.device)
        os.close(pair.fd)
        _, said = pair.process.communicate(timeout=PATIENCE)
        expect("exit status", pair.process.returncode, 1)
        expect("says why", b"gone" in said, True)


if __name__ == "__main__":
    sys.exit(run_tests([value for name, value in list(globals().items()) if name.startswith("test_")]))
