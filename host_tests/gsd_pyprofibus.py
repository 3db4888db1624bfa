#!/usr/bin/env python3
"""pyprofibus brings the station up from gsd/FLDL1234.GSD alone: ident, parameters, configuration and lengths are what the
file says; only addresses and the line are told by hand."""
import os
import sys
import tempfile
import time
from pathlib import Path

import pyprofibus
from pyprofibus.gsd import GsdInterp

import scripted
from station import Station

TOP = Path(__file__).resolve().parent.parent
GSD = TOP / "gsd/FLDL1234.GSD"
CONFIG = """
[PROFIBUS]
debug=0
[PHY]
type=serial
dev={pty}
baud=500000
[DP]
master_class=1
master_addr=2
[SLAVE_0]
name=first
addr=8
gsd={gsd}
sync_mode=1
freeze_mode=1
group_mask=1
watchdog_ms=5000
output_size={outputs}
input_size={inputs}
diag_period=0
"""


def bring_up(station, gsd_path, seconds=10.0):
    """-> inputs after the station has taken outputs 55 AA."""
    gsd = GsdInterp.fromFile(str(gsd_path))
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "station.conf"
        # its names are the slave's: input_size is what the slave gets
        config.write_text(CONFIG.format(pty=station.pty, gsd=gsd_path, inputs=gsd.getField("Max_Output_Len"),
                                        outputs=gsd.getField("Max_Input_Len")))
        conf = pyprofibus.PbConf.fromFile(str(config))
    master = conf.makeDPM()
    try:
        slave = conf.slaveConfs[0].makeDpSlaveDesc()
        master.addSlave(slave)
        master.initialize()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            slave.setMasterOutData(bytearray(b"\x55\xaa"))
            master.run()
            inputs = slave.getMasterInData()
            if inputs is not None and station.ask("out")["out"] == "55AA":
                return bytes(inputs)
        raise AssertionError(f"no data exchange in {seconds} s")
    finally:
        master.destroy()


def test_the_station_comes_up_from_the_file_alone():
    with Station("fieldling-dp", "--address", "8") as station:
        station.ask("in 1 33")
        inputs = bring_up(station, GSD)
        assert inputs == bytes((33, 0)), inputs
        status = station.ask("status")
        assert status["state"] == "DATA_EXCH" and status["master"] == "2", status


def test_with_another_ident_in_the_file_it_does_not():
    with tempfile.TemporaryDirectory() as folder, Station("fieldling-dp", "--address", "8") as station:
        path = Path(folder) / "FLDL1235.GSD"
        path.write_bytes(GSD.read_bytes().replace(b"Ident_Number=0x1234", b"Ident_Number=0x1235"))
        try:
            bring_up(station, path, 2.0)
        except AssertionError:
            assert station.ask("status")["state"] == "WAIT_PRM"
        else:
            raise AssertionError("the station took the parameters of another device")


if __name__ == "__main__":
    os.chdir(TOP)
    sys.exit(scripted.run(globals(), __file__))
