#!/usr/bin/env python3
"""pyprofibus 1.13, a DP master nobody here wrote, drives fieldling-dp over a pseudo terminal.

Each exchange carries a number; after each one the station's console must show that very number, and its count of
executed exchanges must be that number too: none lost, none doubled.

Two habits of this master are dealt with on its side:
  - it forgets its outputs once they are sent, so that a retry would carry new data under the same FCB: here the
    same data are given again until they are answered;
  - it does not toggle FCB when a slave answers Data_Exchange with SC: handle_short_ack().
"""
import sys
import time

import pyprofibus.dp_master
from pyprofibus.dp import DpCfgDataElement
from pyprofibus.dp_master import DPM1, DpSlaveDesc, DpSlaveState
from pyprofibus.phy_serial import CpPhySerial

from station import Station, expect, run_tests

EXCHANGES = 1000
ADDRESS = 8
MASTER = 2
IDENT = 0x1234
MODULES = (0x10, 0x20, 0x10, 0x20)  # an octet in, one out, one in, one out
RATE = 500000


def handle_short_ack():
    release = pyprofibus.dp_master.DpMaster._releaseSlave

    def toggle_and_release(master, slave):
        if slave.getState() == DpSlaveState.STATE_DX and slave.shortAckReceived:
            slave.fcb.handleReply()
            slave.shortAckReceived = False
        release(master, slave)

    pyprofibus.dp_master.DpMaster._releaseSlave = toggle_and_release


class LossyPhy(CpPhySerial):
    """Loses every 11th request and every 7th answer: never two answers in a row, because then this master asks for
    diagnosis under the old FCB and repeats its data as new ones. On a busy machine a late answer may be a lost one all
    the same: so what left for the station is counted, data that differ from the telegram before are new ones."""

    requests = answers = exchanges = 0
    last = b""

    def sendData(self, telegramData, srd):
        self.requests += 1
        if self.requests % 11:
            telegram = bytes(telegramData)
            if telegram[:6] == bytes((0x68, 5, 5, 0x68, ADDRESS, MASTER)) and telegram != self.last:
                self.exchanges += 1
            self.last = telegram
            super().sendData(telegramData, srd)

    def pollData(self, timeout=0.0):
        data = super().pollData(timeout)
        if data:
            self.answers += 1
        return data if self.answers % 7 else None


class Master:
    """A class 1 master with DP-TEST01 as its only slave, described by hand."""

    def __init__(self, pty, watchdog_ms=5000, phy_class=CpPhySerial, address=ADDRESS, rate=RATE):
        self.phy = phy_class(port=pty)
        self.phy.setConfig(baudrate=rate)
        self.dp = DPM1(phy=self.phy, masterAddr=MASTER)
        self.slave = DpSlaveDesc()
        self.slave.slaveAddr = address
        self.slave.inputSize = 2   # from the slave's side: master to slave
        self.slave.outputSize = 2  # slave to master
        for telegram in (self.slave.setPrmTelegram, self.slave.chkCfgTelegram):
            telegram.da = address
        self.slave.setPrmTelegram.identNumber = IDENT
        self.slave.setCfgDataElements([DpCfgDataElement(module) for module in MODULES])
        self.slave.setWatchdog(watchdog_ms)
        self.slave.setSyncMode(True)
        self.slave.setFreezeMode(True)
        self.slave.setGroupMask(1)
        self.dp.addSlave(self.slave)
        self.dp.initialize()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.dp.destroy()

    def exchange(self, outputs, seconds=10.0):
        """Give outputs until inputs come back. -> inputs"""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.slave.setMasterOutData(bytearray(outputs))
            self.dp.run()
            inputs = self.slave.getMasterInData()
            if inputs is not None:
                return bytes(inputs)
        raise AssertionError(f"no inputs in {seconds} s")


def number(n):
    return bytes((n >> 8, n & 0xFF))


def executed(station, n, exchanges=None):
    """Exchange n is the last of n executed ones (or of so many). -> status"""
    # the main loop takes the outputs after the answer has left
    station.wait(lambda: int(station.ask("out")["out"], 16) >= n, f"output {n}")
    status = station.ask("status")
    expect(f"outputs after exchange {n}", int(status["out"], 16), n)
    expect("exchanges executed", int(status["data_exchange"]), n if exchanges is None else exchanges)
    return status


def test_thousand_exchanges_none_lost_none_doubled():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, Master(station.pty) as master:
        for n in range(1, EXCHANGES + 1):
            master.exchange(number(n))
            status = executed(station, n)
        expect("state", status["state"], "DATA_EXCH")
        expect("owner", status["master"], str(MASTER))
        expect("group", status["groups"], "01")
        for fault in ("sd_error_count", "parity", "format", "checksum", "wrong_length", "wd_expired", "refused"):
            expect(fault, status[fault], "0")


def test_exchanges_at_full_speed_are_all_executed():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, Master(station.pty) as master:
        for n in range(1, EXCHANGES + 1):
            master.exchange(number(n))
        executed(station, EXCHANGES)


def test_lost_requests_and_answers_neither_lose_nor_double_data():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, \
            Master(station.pty, phy_class=LossyPhy) as master:
        for n in range(1, 201):
            master.exchange(number(n))
            status = executed(station, n, master.phy.exchanges)
        if int(status["retries"]) < 20:
            raise AssertionError(f"only {status['retries']} retries: the line did not lose answers")


def test_inputs_set_at_the_station_arrive_at_the_master():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, Master(station.pty) as master:
        for value in range(0, 256, 5):
            station.ask(f"in 1 {value}")
            station.ask(f"in 3 {255 - value}")
            for _ in range(50):  # an exchange on its way carries the old ones
                inputs = master.exchange(b"\x00\x00")
                if inputs == bytes((value, 255 - value)):
                    break
            expect("inputs", inputs, bytes((value, 255 - value)))


def test_sync_holds_outputs_until_the_next_sync_and_unsync_lets_them_through():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, Master(station.pty) as master:
        master.exchange(number(1))
        executed(station, 1)
        master.dp.syncMode(groupMask=1)
        station.wait(lambda: station.ask("status")["sync"] == "1", "Sync")
        master.exchange(number(2))
        master.exchange(number(3))
        expect("outputs while held", station.ask("out")["out"], "0001")
        master.dp.syncMode(groupMask=1)
        station.wait(lambda: station.ask("out")["out"] == "0003", "the output of the second Sync")
        master.exchange(number(4))
        master.dp.syncModeCancel(groupMask=2)  # another group's
        master.exchange(number(5))
        expect("outputs while held", station.ask("out")["out"], "0003")
        master.dp.syncModeCancel(groupMask=1)
        station.wait(lambda: station.ask("out")["out"] == "0005", "the output of Unsync")
        master.exchange(number(6))
        station.wait(lambda: station.ask("out")["out"] == "0006", "the next output")


def test_freeze_holds_inputs_until_the_next_freeze_and_unfreeze_lets_them_through():
    def inputs_become(value):
        for _ in range(50):
            if master.exchange(b"\x00\x00")[0] == value:
                return True
        return False

    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, Master(station.pty) as master:
        station.ask("in 1 1")
        expect("input 1 arrives", inputs_become(1), True)
        master.dp.freezeMode(groupMask=0)
        station.wait(lambda: station.ask("status")["freeze"] == "1", "Freeze")
        station.ask("in 1 2")
        expect("input 2 arrives while frozen", inputs_become(2), False)
        master.dp.freezeMode(groupMask=0)
        expect("input 2 arrives with the second Freeze", inputs_become(2), True)
        station.ask("in 1 3")
        expect("input 3 arrives while frozen", inputs_become(3), False)
        master.dp.freezeModeCancel(groupMask=0)
        expect("input 3 arrives with Unfreeze", inputs_become(3), True)


def test_diagnosis_is_fetched_and_data_go_on():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station, Master(station.pty) as master:
        n = 1
        master.exchange(number(n))
        for blocks in ("0201", "8841214400010088", "clear"):  # a device related block; garbage; gone
            station.ask(f"diag {blocks}")
            for _ in range(20):
                n += 1
                master.exchange(number(n))
        status = executed(station, n)
        expect("state", status["state"], "DATA_EXCH")
        expect("diagnosis read", int(status["requests"]) - n >= 4 + 2, True)  # bring-up, and twice more


def test_station_outlives_its_master_and_takes_the_next():
    with Station("fieldling-dp", "--address", str(ADDRESS)) as station:
        for n in (1, 2, 3):
            with Master(station.pty, watchdog_ms=200) as master:
                master.exchange(number(n))
                expect("state", station.ask("status")["state"], "DATA_EXCH")
            station.wait(lambda: station.ask("status")["wd_expired"] == str(n), "the watchdog")
            status = station.ask("status")
            expect("state without a master", status["state"], "WAIT_PRM")
            expect("outputs without a master", status["out"], "0000")


if __name__ == "__main__":
    handle_short_ack()
    sys.exit(run_tests([
        test_thousand_exchanges_none_lost_none_doubled,
        test_exchanges_at_full_speed_are_all_executed,
        test_lost_requests_and_answers_neither_lose_nor_double_data,
        test_inputs_set_at_the_station_arrive_at_the_master,
        test_sync_holds_outputs_until_the_next_sync_and_unsync_lets_them_through,
        test_freeze_holds_inputs_until_the_next_freeze_and_unfreeze_lets_them_through,
        test_diagnosis_is_fetched_and_data_go_on,
        test_station_outlives_its_master_and_takes_the_next,
    ]))
