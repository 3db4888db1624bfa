#!/usr/bin/env python3
"""sim/sigrok/profibus_dp in the distribution's sigrok-cli, on a capture of levels that is made here."""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import scripted

TOP = Path(__file__).resolve().parent.parent
CLI = shutil.which("sigrok-cli")
BAUD, SAMPLES = 500000, 10  # samples a bit


class Wave:
    """Levels of one line, as a logic analyzer sees them: 8E1, lowest bit first."""

    def __init__(self):
        self.levels = bytearray()
        self.idle(50)

    def idle(self, bits):
        self.levels += b"\1" * (bits * SAMPLES)
        return self

    def octets(self, text, bad_parity_at=None):
        for i, octet in enumerate(bytes.fromhex(text)):
            bits = [octet >> b & 1 for b in range(8)]
            parity = sum(bits) % 2 ^ (i == bad_parity_at)
            for level in [0, *bits, parity, 1]:
                self.levels += bytes([level]) * SAMPLES
        return self

    def decoded(self, *classes):
        """Annotations in the order of time, without their sample numbers."""
        self.idle(50)
        with tempfile.TemporaryDirectory() as folder:
            capture = Path(folder) / "capture.bin"
            capture.write_bytes(self.levels)
            wanted = ",".join("profibus_dp=" + c for c in classes)
            result = subprocess.run(
                [CLI, "-I", f"binary:numchannels=1:samplerate={BAUD * SAMPLES}", "-i", str(capture), "-C", "0", "-P",
                 f"uart:rx=0:baudrate={BAUD}:parity=even,profibus_dp", "-A", wanted.replace(",profibus_dp=", ":")],
                capture_output=True, timeout=60,
                env=dict(os.environ, SIGROKDECODE_DIR=str(TOP / "sim/sigrok"), HOME=folder))
        assert result.returncode == 0 and not result.stderr, result.stderr.decode()
        return [line.split(": ", 1)[1] for line in result.stdout.decode().splitlines()]


def expect(have, *wanted):
    assert have == list(wanted), "\n".join(["is:", *have, "expected:", *wanted])


def test_sigrok_is_there():
    assert CLI, "sigrok-cli is missing: make setup"


def test_request_and_answer_with_t_sdr():
    wave = (Wave().octets("68 05 05 68 88 82 6D 3C 3E F1 16").idle(14)
            .octets("68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16"))
    expect(wave.decoded("telegram", "time"), "2.62 -> 8.60 Slave_Diag request",
           "8.60 -> 2.62 Slave_Diag answer DL", "T_SDR 14 T_bit")


def test_fields():
    wave = Wave().octets("68 07 07 68 FF 82 44 3A 3E 00 00 3D 16")
    expect([line.strip('"').split('" "')[0] for line in wave.decoded("field", "data")],
           "SD2", "LE 7", "LEr", "SD2", "DA 127", "SA 2", "FC 44", "DSAP 58", "SSAP 62", "DU 00 00", "FCS", "ED")


def test_all_formats():
    wave = (Wave().octets("DC 03 02").idle(40).octets("10 08 02 49 53 16").idle(11).octets("10 02 08 00 0A 16").idle(40)
            .octets("A2 08 02 7D 42 24 00 01 02 03 04 05 FC 16").idle(20).octets("E5"))
    expect(wave.decoded("telegram", "time"), "2 -> 3 Token", "2 -> 8 FDL Status request", "8 -> 2 FDL Status answer OK",
           "T_SDR 11 T_bit", "2 -> 8 Data_Exchange request", "8 -> 2 Short acknowledge of Data_Exchange", "T_SDR 20 T_bit")


def test_what_is_wrong_is_told_and_t_syn_starts_anew():
    wave = (Wave().octets("10 08 02 49 54 16").idle(40).octets("68 05 06 68 88 82").idle(40)
            .octets("10 08 02 49 53 16", bad_parity_at=2).idle(40).octets("10 08 02").idle(40)
            .octets("10 56 65 03 88 16").idle(40).octets("10 08 02 49 53 17").idle(40).octets("55 AA").idle(40)
            .octets("68 03 03 68").idle(40).octets("68 04 04 68 88 82 6D 3C B3 16").idle(40).octets("10 08 02 49 53 16"))
    expect(wave.decoded("telegram", "warning"), "FCS is 54, right is 53", "LE 05 is not LEr 06",
           "Parity or framing error in octet 3", "Cut short: 3 octets", "FCS is 88, right is BE",
           "End delimiter is 17, not 16", "55 is no start delimiter", "LE is 3, allowed is 4 to 249",
           "No room for the SAPs", "2 -> 8 FDL Status request")


def test_a_refusal():
    wave = Wave().octets("68 05 05 68 03 02 7D 01 02 85 16").idle(15).octets("10 02 03 03 08 16")
    expect(wave.decoded("telegram"), "2 -> 3 Data_Exchange request", "3 -> 2 Data_Exchange answer RS")


if __name__ == "__main__":
    sys.exit(scripted.run(globals(), __file__))
