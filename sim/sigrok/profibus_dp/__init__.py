"""PROFIBUS-DP on top of the UART decoder (8 data bits, even parity), for sigrok-cli and PulseView.

    SIGROKDECODE_DIR=sim/sigrok sigrok-cli -i capture.sr -P uart:rx=D0:baudrate=500000:parity=even,profibus_dp
"""
from .pd import Decoder
