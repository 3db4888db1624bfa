#!/usr/bin/env python3
"""The GSD file: it is what the configuration says, other tools read it, and gsd/check finds what is broken."""
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import traceback
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import scripted

TOP = Path(__file__).resolve().parent.parent
BIN = Path(os.environ.get("FIELDLING_BIN", "build/posix"))
OURS = TOP / "gsd/FLDL1234.GSD"
GSDTOOL = TOP / "build/cargo/bin/gsdtool"


def run(*command):
    return subprocess.run([str(c) for c in command], cwd=TOP, capture_output=True, timeout=60)


sys.dont_write_bytecode = True
LOADER = SourceFileLoader("gsd_checker", str(TOP / "gsd/check"))
CHECKER = module_from_spec(spec_from_loader(LOADER.name, LOADER))
LOADER.exec_module(CHECKER)


def check(path):
    """-> exit status, output; in this process, because there are hundreds of files."""
    output = io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
        try:
            status = CHECKER.main([str(TOP / path)])
        except Exception:  # what would stop the checker
            traceback.print_exc(file=output)
            status = None
    return status, output.getvalue()


# ---- what gsd/check must find: (find, replace, message), applied to our own file, which is good -------------
# The message must stand at the line of the replacement, or at line 1 where something is missing.

def missing(keyword):
    return (rf"^{re.escape(keyword)}=.*\n", "", f"1: error: {keyword} is missing")


BROKEN = [missing(k) for k in (
    "GSD_Revision Vendor_Name Model_Name Revision Ident_Number Protocol_Ident Station_Type FMS_supp Hardware_Release "
    "Software_Release Redundancy Repeater_Ctrl_Sig 24V_Pins Freeze_Mode_supp Sync_Mode_supp Auto_Baud_supp "
    "Set_Slave_Add_supp Min_Slave_Intervall Modular_Station Slave_Family Max_Diag_Data_Len Fail_Safe Modul_Offset "
    "Max_Module Max_Input_Len Max_Output_Len Max_Data_Len Max_User_Prm_Data_Len").split()]
BROKEN += [
    (r"#Profibus_DP\n", "", "1: error: no line #Profibus_DP"),
    (r"^Ident_Number=0x1234", "Ident_Number=0x1235", "Ident_Number is 1235H, the file name says 1234H"),
    (r"^Ident_Number=0x1234", "Ident_Number=xyz", "'xyz' is not a number"),
    (r"^Ident_Number=0x1234", "Ident_Number=0x12345", "is 74565, allowed is 0 to 65535"),
    (r'^Revision="V0.1"\n', 'Revision="V0.1"\nRevision="V0.2"\n', "Revision again, first in line"),
    (r'^Revision="V0.1"', "Revision=V0.1", "text in quotation marks expected"),
    (r'^Revision="V0.1"', 'Revision="V0.1', "quotation mark without its partner"),
    (r'^Vendor_Name="Fieldling"', f'Vendor_Name="{"x" * 33}"', "has 33 characters, 32 are allowed"),
    (r'^Vendor_Name="Fieldling"', 'Vendor_Name=""', "Vendor_Name is empty"),
    (r'^Model_Name="DP-TEST01"', 'Model_Name="DP\x07"', "control character"),
    (r"^Protocol_Ident=0", "Protocol_Ident=1", "Protocol_Ident must be 0"),
    (r"^Station_Type=0", "Station_Type=1", "Station_Type must be 0"),
    (r"^FMS_supp=0", "FMS_supp=2", "FMS_supp is 2, allowed is 0 to 1"),
    (r"^Slave_Family=.*", "Slave_Family=13@x", "Slave_Family '13@x'"),
    (r"^MaxTsdr_500=100\n", "", "MaxTsdr_500 is missing"),
    (r"^MaxTsdr_500=100", "MaxTsdr_500=5", "MaxTsdr_500 is 5, allowed is 11"),
    (r"^500_supp=1", "500_supp=yes", "'yes' is not a number"),
    (r"(?s)^9.6_supp.*12M_supp=1\n", "", "1: error: no rate is supported"),
    (r"^Min_Slave_Intervall=1", "Min_Slave_Intervall=0", "Min_Slave_Intervall is 0"),
    (r"^Max_Diag_Data_Len=64", "Max_Diag_Data_Len=999", "Max_Diag_Data_Len is 999, allowed is 6 to 244"),
    (r"^Max_Diag_Data_Len=64", "Max_Diag_Data_Len=5", "Max_Diag_Data_Len is 5"),
    (r"^Unit_Diag_Bit\(0\)", "Unit_Diag_Bit(456)", "leaves bits 0 to 455"),
    (r"^(Unit_Diag_Bit.*\n)", r'\1Unit_Diag_Bit(0)="x"\n', "Unit_Diag_Bit(0) again"),
    (r"^Unit_Diag_Bit\(0\)", "Unit_Diag_Bit", "a number in brackets expected"),
    (r"^Unit_Diag_Bit.*", "Unit_Diag_Area=9-3\nUnit_Diag_Area_End", "Unit_Diag_Area=first-last expected"),
    (r"^Max_User_Prm_Data_Len=3", "Max_User_Prm_Data_Len=2", "constants end at octet 3, Max_User_Prm_Data_Len is 2"),
    (r"^Max_User_Prm_Data_Len=3", "Max_User_Prm_Data_Len=238", "is 238, allowed is 0 to 237"),
    (r"^Ext_User_Prm_Data_Const.*\n", "", "Ext_User_Prm_Data_Const is missing"),
    (r"^(Ext_User_Prm_Data_Const.*)0x00$", r"\g<1>0x100", "is not a list of octets"),
    (r"^Ext_User_Prm_Data_Ref\(1\)=2", "Ext_User_Prm_Data_Ref(1)=7", "there is no ExtUserPrmData=7"),
    (r"^Ext_User_Prm_Data_Ref\(1\)=2", "Ext_User_Prm_Data_Ref(3)=2", "parameter ends at octet 4"),
    (r"^ExtUserPrmData=2", "ExtUserPrmData=1", "ExtUserPrmData=1 again"),
    (r"^Prm_Text_Ref=1", "Prm_Text_Ref=4", "there is no such PrmText"),
    (r"^PrmText=1", "PrmText=one", "'one' is not a number"),
    (r"^Text\(1\)", "Text(0)", "Text(0) again"),
    (r"^Bit\(0\) 1 0-1", "Bit(8) 1 0-1", "no such parameter type"),
    (r"^Bit\(0\) 1 0-1", "Bit(0) 1 0-2", "values 0-2 do not fit the type (0-1)"),
    (r"^Unsigned8 0 0-100", "Unsigned8 101 0-100", "default 101 is not within 0-100"),
    (r"^Unsigned8 0 0-100", "Unsigned8 0 0-256", "do not fit the type (0-255)"),
    (r"^Unsigned8 0 0-100", "Unsigned8 3 0,1,2", "default 3 is not one of the values 0,1,2"),
    (r"^Unsigned8 0 0-100", "Unsigned8 many", "default and values expected"),
    (r"^EndExtUserPrmData\nMax", "Max", "has no end"),
    (r"^EndPrmText\n", "", "inside the block of line"),
    (r"^EndModule\n\Z", "", "has no end"),
    (r"^PrmText=1", "EndModule\nPrmText=1", "EndModule without a beginning"),
    (r"^Max_Input_Len=2", "Max_Input_Len=1", "the preset configuration has 2 input octets, Max_Input_Len is 1"),
    (r"^Max_Input_Len=2", "Max_Input_Len=245", "is 245, allowed is 0 to 244"),
    (r"^Max_Output_Len=2", "Max_Output_Len=1", "2 output octets, Max_Output_Len is 1"),
    (r"^Max_Data_Len=4", "Max_Data_Len=3", "the preset configuration has 4 data octets, Max_Data_Len is 3"),
    (r"^Max_Data_Len=4", "Max_Data_Len=5", "Max_Data_Len is 5, inputs and outputs together 4"),
    (r"^Max_Data_Len=4", "Max_Data_Len=1", "less than inputs or outputs alone"),
    (r"^Max_Module=4", "Max_Module=3", "4 modules are preset, Max_Module is 3"),
    (r"^Modular_Station=1", "Modular_Station=0", "a compact station has one Module, not 4"),
    (r"^(Module=\"Sens.*) 0x10", r"\1 0x1F", "has 16 input octets, Max_Input_Len is 2"),
    (r"^(Module=\"Sens.*) 0x10", r"\1 0xC4,0x87", "announces 6 more octets, 1 follow"),
    (r"^(Module=\"Sens.*) 0x10", r"\1 0x110", "identifier octets expected"),
    (r"^(Module=\"Sens.*) 0x10", r"\1", "identifier octets expected"),
    (r'^Module="Sensor, 1 byte in"', 'Module="Temperature, 1 byte in"', "again"),
    (r"^3\nPreset", "2\nPreset", "module reference 2 again"),
    (r"^3\nPreset", "Preset", "has no reference number"),
    (r"(?s)^Module=.*", "", "1: error: no Module"),
    (r"^DPV1_Slave=0\n(?s:(.*))Max_User_Prm_Data_Len=3\n.*\n.*\n.*\n",
     r"DPV1_Slave=1\n\1Max_User_Prm_Data_Len=0\n", "a DP-V1 slave has at least 3 octets"),
    (r"^DPV1_Slave=0", f"DPV1_Slave=0 ; {'x' * 80}", "line has 95 characters, 80 are allowed"),
    (r"^DPV1_Slave=0", "User_Prm_Data_Len=5\nUser_Prm_Data=1,2,3", "User_Prm_Data has 3 octets, User_Prm_Data_Len is 5"),
    (r"^DPV1_Slave=0", "User_Prm_Data_Len=5", "User_Prm_Data_Len without User_Prm_Data"),
    (r"^DPV1_Slave=0", "User_Prm_Data=1", "User_Prm_Data without User_Prm_Data_Len"),
    (r"^DPV1_Slave=0", "= 5", "not a statement"),
    (r"^DPV1_Slave=0", "Fail_Safe", "Fail_Safe again"),
    (r"^(Unit_Diag_Bit.*\n)", r'\1Channel_Diag(9)="x"\n', "a maker's own errors are 16 to 31"),
    (r"\Z", "SlotDefinition\nSlot(1)=\"a\" 5 1,2\nEndSlotDefinition\n", "default module 5 is not one of the allowed"),
    (r"\Z", "SlotDefinition\nSlot(1)=\"a\" 1 1-9\nEndSlotDefinition\n", "slot allows module 5, which is not there"),
    (r"EndModule\n\Z", "EndModule \\\\", "the file ends in a continued line"),
]


def test_the_committed_file_is_the_generated_one():
    generated = run(BIN / "fieldling-gsd")
    name = run(BIN / "fieldling-gsd", "--name").stdout.decode().strip()
    assert generated.returncode == 0
    assert name == OURS.name, name
    assert generated.stdout == OURS.read_bytes(), "gsd/FLDL1234.GSD is old: make gsd"


def test_our_file_is_good():
    assert run(sys.executable, "gsd/check", OURS).returncode == 0
    status, output = check(OURS)
    assert status == 0 and "good, 4 modules" in output, output


def test_three_makers_styles_are_accepted():
    for sample in sorted((TOP / "host_tests/gsd_samples").iterdir()):
        status, output = check(sample)
        assert status == 0 and ": good," in output, output


def test_every_broken_file_is_found():
    good = OURS.read_bytes().decode().replace("\r\n", "\n")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / OURS.name
        for find, replace, message in BROKEN:
            text, n = re.subn(find, replace, good, count=1, flags=re.M)
            assert n == 1, f"{find} is not in our file"
            path.write_bytes(text.replace("\n", "\r\n").encode())
            status, output = check(path)
            assert status == 1, f"{find} -> {replace}: exit {status}\n{output}"
            assert message in output, f"{find} -> {replace}: {message!r} expected\n{output}"
            assert "Traceback" not in output, output


def test_the_line_of_an_error_is_right():
    good = OURS.read_bytes().decode()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / OURS.name
        for number, line in enumerate(good.split("\r\n"), 1):
            if line.startswith("Max_Diag_Data_Len"):
                break
        path.write_bytes(good.replace("Max_Diag_Data_Len=64", "Max_Diag_Data_Len=\\\r\n5").encode())
        assert f"{OURS.name}:{number}: error: Max_Diag_Data_Len is 5" in check(path)[1]


def test_a_file_of_another_name_is_told():
    with tempfile.TemporaryDirectory() as folder:
        for name, message in (("FLDL1235.GSD", "the file name says 1235H"), ("station.gsd", "four characters")):
            shutil.copy(OURS, Path(folder) / name)
            status, output = check(Path(folder) / name)
            assert status == 1 and message in output, output


def test_a_file_that_cannot_be_read_is_status_2():
    assert check("no/such.gsd")[0] == 2


def test_random_damage_never_breaks_the_checker():
    import random
    source = random.Random(1)
    good = OURS.read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / OURS.name
        for _ in range(3000 if os.environ.get("TEST_FULL") else 20):
            text = bytearray(good)
            for _ in range(source.randrange(1, 6)):
                at = source.randrange(len(text))
                text[at:at + source.randrange(3)] = bytes(source.choices(b'"=;()\\\r\n0xF,- aZ\xff', k=source.randrange(3)))
            path.write_bytes(bytes(text))
            status, output = check(path)
            assert status in (0, 1) and "Traceback" not in output, output


def test_pyprofibus_gsdparser_names_the_device():
    result = run(Path(sys.executable).parent / "gsdparser", "--summary", OURS)
    assert result.returncode == 0, result.stderr.decode()
    assert "Fieldling; DP-TEST01; V0.1; Ident 0x1234" in result.stdout.decode(), result.stdout.decode()


def test_pyprofibus_reads_parameters_and_configuration():
    from pyprofibus.gsd import GsdInterp
    gsd = GsdInterp.fromFile(str(OURS))
    assert gsd.getIdentNumber() == 0x1234
    # the default: over-temperature diagnosed, limit 0; three octets
    assert bytes(gsd.getUserPrmData()) == bytes((1, 0, 0))
    assert [bytes(e.getDU()) for e in gsd.getCfgDataElements()] == [b"\x10", b"\x20", b"\x10", b"\x20"]


# Board -> header with its clock, the clock's name there, what the UART divides it by before its own divisor, the smallest
# divisor. From the chips' data sheets: 8052 Timer 2 (32), 16550 (16), STM32F1 USART (BRR 16 at least), PL011 (16, in 1/64).
CLOCKS = {
    "87c51fb": ("wiring.h", "FOSC_HZ", 32, 1),
    "stc89c58rd": ("wiring.h", "FOSC_HZ", 32, 1),
    "com86": ("hal_board.h", "BOARD_UART_HZ", 16, 1),
    "bluepill": ("hal_board.h", "BOARD_LINE_CLOCK_HZ", 1, 16),
    "lm3s6965evb": ("hal_board.h", "BOARD_CORE_HZ", 16 / 64, 64),
    "rv32virt": ("hal_board.h", "BOARD_LINE_HZ", 16, 1),
}
BIT_PER_S = {"9.6": 9600, "19.2": 19200, "45.45": 45450, "93.75": 93750, "187.5": 187500, "500": 500000, "1.5M": 1500000,
             "3M": 3000000, "6M": 6000000, "12M": 12000000}


def test_each_boards_file_has_the_rates_its_clock_can_make():
    """PROFIBUS allows 0.3 % (spec A1)."""
    boards = {p.parent.name for p in (TOP / "boards").glob("*/dp_rates.h")} - {"posix"}
    assert boards == set(CLOCKS), boards
    for board, (header, name, before, least) in CLOCKS.items():
        status, output = check(f"build/gsd/{board}/FLDL1234.GSD")
        assert status == 0, output
        text = (TOP / f"build/gsd/{board}/FLDL1234.GSD").read_text()
        clock = int(re.search(rf"#define {name} +(\d+)", (TOP / f"boards/{board}/{header}").read_text()).group(1)) / before
        can = [r for r, n in BIT_PER_S.items() if round(clock / n) >= least and abs(clock / round(clock / n) - n) <= 0.003 * n]
        assert re.findall(r"^(.*)_supp=1\r?$", text.split("Auto_Baud")[0], re.M) == can, (board, can)


def test_gsdtool_reads_it():
    if not GSDTOOL.exists():
        return "gsdtool could not be installed: no Rust, or see build/cargo/install.log"
    result = run(GSDTOOL, "dump", OURS)
    text = result.stdout.decode()
    assert result.returncode == 0, result.stderr.decode()
    for line in ("ident_number: 4660", "max_modules: 4", "max_diag_data_length: 64", "b12000000: 800",
                 'name: "Temperature, 1 byte in"', "fail_safe: true"):
        assert line in text, f"{line} not in\n{text}"
    return None


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), __file__))
