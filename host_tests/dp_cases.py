"""What a DP slave does, case by case: telegrams, inputs and outputs, for any bench that can play them.

Station 8, DP-TEST01 (ident 1234H, modules 10 20 10 20), master 2; octets by hand, FC 6D: each request is a first one.
EN 50170-2 part 4 (FDL), part 8 (DP); names T... as in test_dp_*.c, where the same is asked of the host station in
virtual time. FCS is the sum of DA..DU modulo 256.

Each case begins at power-up with address switches 8 and inputs 1E 00. A step is the name of a bench's method and its
arguments: ask (request, answer; "" is silence), out (the outputs now), inputs (from now; the station has seen them),
ms (so many milliseconds pass), power (off and on with these switches), new_battery (the non-volatile cells are lost).
Marks in a telegram: `02!` wrong parity, `_33` a pause of 33 T_bit; a bench whose time is the computer's cannot play
those: needs_own_time().
"""
import re


def ASK(request, answer):
    return "ask", request, answer


def SILENT(request):
    return "ask", request, ""


def OUT(octets):
    return "out", octets


def IN(octets):
    return "inputs", octets


def MS(n):
    return "ms", n


def POWER(switches):
    return "power", switches


NEW_BATTERY = ("new_battery",)

ACK = "E5"
STATUS = "10 08 02 49 53 16"
STATUS_OK = "10 02 08 00 0A 16"
STILL_ANSWERS = ASK(STATUS, STATUS_OK)
RS = "10 02 08 03 0D 16"
RR = "10 02 08 02 0C 16"
GET_DIAG = "68 05 05 68 88 82 6D 3C 3E F1 16"
SET_PRM = "68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 BB 16"     # lock, no watchdog, group 1
SET_PRM_SF = "68 0C 0C 68 88 82 6D 3D 3E B0 01 01 00 12 34 01 EB 16"  # and Sync, Freeze allowed
SET_PRM_WD = "68 0C 0C 68 88 82 6D 3D 3E 88 01 14 00 12 34 01 D6 16"  # and watchdog 1 x 20 x 10 ms
CHK_CFG = "68 09 09 68 88 82 6D 3E 3E 10 20 10 20 53 16"
DX = "68 05 05 68 08 02 6D 11 22 AA 16"
DX_33_44 = "68 05 05 68 08 02 6D 33 44 EE 16"
DX_55_66 = "68 05 05 68 08 02 6D 55 66 32 16"
DX_OK = "68 05 05 68 02 08 08 1E 00 30 16"  # inputs 1E 00
DX_DH = "68 05 05 68 02 08 0A 1E 00 32 16"  # a diagnosis is pending

# Slave_Diag octets 1, 2: Station_Not_Ready 02, Cfg_Fault 04, Prm_Fault 40 | Prm_Req 01, always 04, WD_On 08,
# Freeze 10, Sync 20; then octet 3, owner, ident
WAITS_PRM = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16")
WAITS_CFG = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 04 00 02 12 34 DA 16")
EXCHANGES = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16")
EXCHANGES_WD = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 12 34 E0 16")
EXCHANGES_SF = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 34 00 02 12 34 08 16")
PRM_FAULT = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 12 34 18 16")
CFG_FAULT = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 06 05 00 FF 12 34 DC 16")

PRM_OK = ASK(SET_PRM, ACK)
CFG_OK = ASK(CHK_CFG, ACK)
TO_DATA_EXCH = [PRM_OK, CFG_OK, EXCHANGES]
TO_DATA_EXCH_SF = [ASK(SET_PRM_SF, ACK), CFG_OK, EXCHANGES]
TO_DATA_EXCH_WD = [ASK(SET_PRM_WD, ACK), CFG_OK, EXCHANGES_WD]

CASES = []


def case(name, *steps):
    """Lists of steps among the steps are taken as if written out."""
    flat = []
    for step in steps:
        flat += step if isinstance(step, list) else [step]
    CASES.append((name, flat))


def needs_own_time(steps):
    """Does a case play with parity, bit times or milliseconds?"""
    return any(step[0] == "ms" or step[0] == "ask" and re.search("[!_]", step[1]) for step in steps)


# ---- who is meant, what is a telegram: part 4, 4.7 -----------------------------------------------------------------

case("T01 SD1, SD2 and SD3 to the own address are answered",
     STILL_ANSWERS, WAITS_PRM, ASK("A2 88 82 6D 3E 3E 00 00 00 00 00 00 F3 16", ACK))
case("T02 telegrams to other stations are not answered",
     SILENT("10 09 02 49 54 16"), SILENT("10 00 02 49 4B 16"), SILENT("10 7D 02 49 C8 16"),
     SILENT("68 05 05 68 89 82 6D 3C 3E F2 16"), SILENT("A2 89 82 6D 3E 3E 00 00 00 00 00 00 F4 16"), STILL_ANSWERS)
case("T03 a station with an address does not answer at 126",
     SILENT("10 7E 02 49 C9 16"), SILENT("68 05 05 68 FE 82 6D 3C 3E 67 16"), STILL_ANSWERS)
case("T04 a broadcast is not answered, and an SDN in it is taken",
     SILENT("10 7F 02 49 CA 16"), SILENT("68 05 05 68 FF 82 6D 3C 3E 68 16"), TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"),
     SILENT("68 07 07 68 FF 82 46 3A 3E 02 00 41 16"), OUT("00 00"))
case("T06 every master is answered to its address",
     ASK("10 08 00 49 51 16", "10 00 08 00 08 16"), ASK("10 08 01 49 52 16", "10 01 08 00 09 16"),
     ASK("10 08 7E 49 CF 16", "10 7E 08 00 86 16"))
case("T07 a wrong FCS is dropped",
     SILENT("10 08 02 49 54 16"), SILENT("68 05 05 68 88 82 6D 3C 3E F0 16"),
     SILENT("A2 88 82 6D 3E 3E 00 00 00 00 00 00 F4 16"), SILENT("10 56 65 03 88 16"), STILL_ANSWERS)
case("T08 a wrong end delimiter is dropped",
     SILENT("10 08 02 49 53 17"), SILENT("68 05 05 68 88 82 6D 3C 3E F1 15"),
     SILENT("A2 88 82 6D 3E 3E 00 00 00 00 00 00 F3 00"), STILL_ANSWERS)
case("T09 different LE and LEr are dropped",
     SILENT("68 05 06 68 88 82 6D 3C 3E F1 16"), SILENT("68 06 05 68 88 82 6D 3C 3E F1 16"), STILL_ANSWERS)
case("T10 LE 0, 2 and 3 are dropped",
     SILENT("68 00 00 68 00 16"), SILENT("68 02 02 68 08 02 0A 16"), SILENT("68 03 03 68 08 02 49 53 16"), STILL_ANSWERS)
case("T11 LE 250 and 255 are dropped",
     SILENT("68 FA FA 68 08 02 6D" + 247 * " 00" + " 77 16"), SILENT("68 FF FF 68 08 02 6D" + 252 * " 00" + " 77 16"),
     STILL_ANSWERS)
case("T12 a wrong second start delimiter is dropped", SILENT("68 05 05 10 88 82 6D 3C 3E F1 16"), STILL_ANSWERS)
case("T13 a telegram too short or too long is dropped",
     SILENT("10 08 02 49 53"), STILL_ANSWERS, SILENT("68 05 05 68 88 82 6D 3C 3E F1"), STILL_ANSWERS,
     SILENT("68 05 05 68 88 82 6D 3C F1 16"), SILENT("A2 88 82 6D 3E 3E 00 00 00 00 00 F3 16"), STILL_ANSWERS)
case("T14 an octet with wrong parity drops the telegram",
     *(SILENT(text) for text in ("10! 08 02 49 53 16", "10 08! 02 49 53 16", "10 08 02! 49 53 16", "10 08 02 49! 53 16",
                                 "10 08 02 49 53! 16", "10 08 02 49 53 16!", "68 05 05 68 88 82 6D 3C! 3E F1 16",
                                 "68 05 05! 68 88 82 6D 3C 3E F1 16", "68 05 05 68 88 82 6D 3C 3E F1! 16",
                                 "A2 88 82 6D 3E 3E 00 00! 00 00 00 00 F3 16")), STILL_ANSWERS)
case("T14 silence inside a telegram drops it",
     SILENT("10 _33 08 02 49 53 16"), SILENT("10 08 02 49 53 _34 16"), SILENT("68 05 05 68 88 82 6D _40 3C 3E F1 16"),
     STILL_ANSWERS)
case("T14 a good telegram right behind a dropped one needs T_SYN",
     SILENT("10 08 02 49 54 16 10 08 02 49 53 16"), SILENT("10 08 02 49 54 16 _21 10 08 02 49 53 16"),
     ASK("10 08 02 49 54 16 _36 10 08 02 49 53 16", STATUS_OK))
case("T15 FDL status is answered in every state",
     STILL_ANSWERS, PRM_OK, STILL_ANSWERS, CFG_OK, EXCHANGES, STILL_ANSWERS)
case("T16 ident tells vendor, controller and releases",
     ASK("10 08 02 4E 58 16", "68 21 21 68 02 08 08 09 09 04 04 46 69 65 6C 64 6C 69 6E 67 "
         "44 50 2D 54 45 53 54 30 31 56 31 2E 30 56 30 2E 31 E6 16"))
case("T16 LSAP status tells what a SAP offers; RS where there is none",
     ASK("68 05 05 68 88 82 4F 3C 3E D3 16", "68 0B 0B 68 82 88 08 3E 3C 7F 00 30 31 13 15 94 16"),
     ASK("68 05 05 68 88 82 4F 0B 3E A2 16", RS))
case("T17 a token is ignored",
     SILENT("DC 08 02"), SILENT("DC 02 02"), ASK("DC 02 02 _36 10 08 02 49 53 16", STATUS_OK))
case("T18 answers of other stations are ignored",
     SILENT("E5"), SILENT("10 02 07 00 09 16"), SILENT("10 08 02 00 0A 16"), SILENT("68 05 05 68 08 02 08 11 22 45 16"),
     SILENT("A2 08 02 08 00 00 00 00 00 00 00 00 12 16"), STILL_ANSWERS)

# ---- frame count bit, retries, SAPs: part 4, 4.1.3 ------------------------------------------------------------------

NEXT_0 = "68 05 05 68 08 02 5D 33 44 DE 16"  # Data_Exchange 33 44, FCB 0 FCV 1
NEXT_1 = "68 05 05 68 08 02 7D 33 44 FE 16"  # FCB 1 FCV 1
IN_21 = "68 05 05 68 02 08 08 21 00 33 16"   # inputs 21 00

case("T19 T20 the first request with FCV 0 and each toggled FCB are new requests",
     TO_DATA_EXCH, ASK(DX, DX_OK), IN("21 00"), ASK(DX, IN_21), ASK(NEXT_0, IN_21), IN("1E 00"), ASK(NEXT_1, DX_OK),
     IN("21 00"), ASK(NEXT_0, IN_21), OUT("33 44"))
case("T21 a retry is answered from store: the inputs of the first time, octet for octet",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK(NEXT_0, DX_OK), IN("21 00"), ASK(NEXT_0, DX_OK), ASK(NEXT_0, DX_OK),
     ASK(NEXT_1, IN_21))
case("T21 a retry is not executed again",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK(NEXT_0, DX_OK), OUT("33 44"), SILENT("68 07 07 68 FF 82 46 3A 3E 02 00 41 16"),
     OUT("00 00"), ASK(NEXT_0, DX_OK), OUT("00 00"), ASK(NEXT_1, DX_OK), OUT("33 44"))
case("T21 the same FCB with other data is a new request",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK(NEXT_0, DX_OK), ASK("68 05 05 68 08 02 5D 55 66 22 16", DX_OK), OUT("55 66"))
case("T21 the FCB of the first request again, with FCV, is a new request",
     TO_DATA_EXCH, ASK(DX, DX_OK), IN("21 00"), ASK(NEXT_1, IN_21), OUT("33 44"))
case("T21 a refusal is repeated, too", ASK(NEXT_0, RS), ASK(NEXT_0, RS))
case("T21 neither FDL status nor a broadcast nor a foreign telegram ends the retry",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK(NEXT_0, DX_OK), IN("21 00"), STILL_ANSWERS,
     SILENT("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16"), SILENT("68 05 05 68 09 02 5D 33 44 DF 16"), ASK(NEXT_0, DX_OK),
     ASK(NEXT_1, IN_21))
case("T21 a retry of Set_Prm does not take parameters again",
     ASK("68 0C 0C 68 88 82 5D 3D 3E 80 01 01 00 12 34 01 AB 16", ACK),
     ASK("68 09 09 68 88 82 7D 3E 3E 10 20 10 20 63 16", ACK),
     ASK("68 09 09 68 88 82 7D 3E 3E 10 20 10 20 63 16", ACK), EXCHANGES)
case("T22 the same frame from another master is no retry",
     ASK("68 05 05 68 88 82 5D 3C 3E E1 16", "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16"),
     ASK("68 05 05 68 88 83 5D 3C 3E E2 16", "68 0B 0B 68 83 88 08 3E 3C 02 05 00 FF 12 34 D9 16"))
case("T23 after power-up nothing is a retry",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK(NEXT_0, DX_OK), POWER(8), ASK(NEXT_0, RS))
case("T25 an SRD or SDA to a SAP that is not active is answered RS",
     *(ASK(f"68 05 05 68 88 82 6D {sap:02X} 3E {0xB5 + sap & 0xFF:02X} 16", RS) for sap in (0, 54, 55, 56, 57, 58)),
     ASK("68 05 05 68 88 82 63 0B 3E B6 16", RS), ASK("68 05 05 68 88 82 65 0B 3E B8 16", RS),
     ASK("68 05 05 68 88 82 6D 3F 3E F4 16", RS))
case("T25 an SDN is never answered",
     SILENT("68 05 05 68 88 82 44 0B 3E 97 16"), SILENT("68 07 07 68 88 82 46 3A 3E 00 00 C8 16"),
     SILENT("68 05 05 68 88 82 44 3C 3E C8 16"), STILL_ANSWERS)
case("T25 SRD of either priority is taken",
     ASK("68 05 05 68 88 82 6C 3C 3E F0 16", "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16"),
     ASK("68 05 05 68 88 82 6C 3B 3E EF 16", "68 09 09 68 82 88 08 3E 3B 10 20 10 20 EB 16"))
case("T25 SDA to a SAP without SDA is answered RS", ASK("68 05 05 68 88 82 65 3C 3E E9 16", RS))
case("T25 functions a responder does not know get no answer",
     SILENT("10 08 02 40 4A 16"), SILENT("10 08 02 47 51 16"), SILENT("10 08 02 4A 54 16"), SILENT("10 08 02 4B 55 16"),
     SILENT("10 08 02 C9 D3 16"), STILL_ANSWERS)

# ---- Set_Prm: part 8; facts 3.7 -------------------------------------------------------------------------------------

case("T26 a good Set_Prm leads to WAIT_CFG and names the owner", WAITS_PRM, PRM_OK, WAITS_CFG)
case("T27 a wrong ident is a parameter fault, and the next good Set_Prm mends it",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 35 01 BC 16", ACK), PRM_FAULT, PRM_OK, WAITS_CFG)
case("T27 a wrong ident throws the owner out of DATA_EXCH",
     TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 35 01 BC 16", ACK),
     OUT("00 00"), PRM_FAULT, ASK(DX, RS))
case("T28 Set_Prm of 0 to 6 octets is a parameter fault",
     ASK("68 05 05 68 88 82 6D 3D 3E F2 16", ACK), PRM_FAULT, ASK("68 06 06 68 88 82 6D 3D 3E 80 72 16", ACK), PRM_FAULT,
     ASK("68 07 07 68 88 82 6D 3D 3E 80 01 73 16", ACK), PRM_FAULT,
     ASK("A2 88 82 6D 3D 3E 80 01 01 00 12 34 BA 16", ACK), PRM_FAULT)
case("T29 0 to 3 user parameters are taken",
     ASK("68 0D 0D 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 BC 16", ACK), WAITS_CFG,
     ASK("68 0E 0E 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 EE 16", ACK), WAITS_CFG,
     ASK("68 0F 0F 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 00 EE 16", ACK), WAITS_CFG)
case("T29 one user parameter more is a parameter fault",
     ASK("68 10 10 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 00 00 EE 16", ACK), PRM_FAULT)
case("T29 the longest Set_Prm is a parameter fault and nothing worse",
     ASK("68 F9 F9 68 88 82 6D 3D 3E 80 01 01 00 12 34 01" + 237 * " 00" + " BB 16", ACK), PRM_FAULT)
case("T30 without lock and unlock nothing but min_T_SDR changes",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 08 01 01 1E 12 34 01 61 16", ACK), WAITS_PRM)
case("T30 min_T_SDR alone changes even with a wrong ident",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 00 01 01 14 FF FF 00 06 16", ACK), WAITS_PRM)
case("T31 unlock gives the station to anyone, and outputs go safe",
     TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), ASK("68 0C 0C 68 88 82 6D 3D 3E 40 01 01 00 12 34 01 7B 16", ACK),
     OUT("00 00"), WAITS_PRM, ASK("68 0C 0C 68 88 83 6D 3D 3E 80 01 01 00 12 34 01 BC 16", ACK),
     ASK("68 05 05 68 88 83 6D 3C 3E F2 16", "68 0B 0B 68 83 88 08 3E 3C 02 04 00 03 12 34 DC 16"))
case("T31 lock and unlock together unlock", ASK("68 0C 0C 68 88 82 6D 3D 3E C0 01 01 00 12 34 01 FB 16", ACK), WAITS_PRM)
case("T32 a locked station ignores lock and unlock of another master",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK("68 0C 0C 68 88 83 6D 3D 3E 80 01 01 00 12 34 01 BC 16", ACK), EXCHANGES,
     ASK("68 0C 0C 68 88 83 6D 3D 3E 40 01 01 00 12 34 01 7C 16", ACK), EXCHANGES, OUT("11 22"), ASK(DX_33_44, DX_OK))
case("T33 Sync not asked for in Set_Prm is not supported",
     TO_DATA_EXCH, SILENT("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"),
     ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 10 04 00 02 12 34 E8 16"), ASK(DX, DX_OK), OUT("11 22"))
case("T33 Sync and Freeze asked for show in Slave_Diag",
     TO_DATA_EXCH_SF, SILENT("68 07 07 68 FF 82 46 3A 3E 28 00 67 16"), EXCHANGES_SF)
case("T34 the watchdog is on or off as Set_Prm says",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 88 0A 64 00 12 34 01 2F 16", ACK),  # 10 s
     ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 12 34 E2 16"), PRM_OK, WAITS_CFG)
case("T35 a watchdog factor 0 is a parameter fault",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 88 00 01 00 12 34 01 C2 16", ACK), PRM_FAULT,
     ASK("68 0C 0C 68 88 82 6D 3D 3E 88 01 00 00 12 34 01 C2 16", ACK), PRM_FAULT)
case("T35 with the watchdog off its factors mean nothing",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 00 12 34 01 B9 16", ACK), WAITS_CFG)
case("T35 the longest watchdog, 255 x 255 x 10 ms, is taken",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 88 FF FF 00 12 34 01 BF 16", ACK),
     ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 12 34 E2 16"))
case("T36 min_T_SDR 11 and 60 are taken",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 3C 12 34 01 F7 16", ACK), WAITS_CFG,
     ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 0B 12 34 01 C6 16", ACK), WAITS_CFG)
case("T36 min_T_SDR 10 and 255 are parameter faults",
     ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 0A 12 34 01 C5 16", ACK), PRM_FAULT,
     ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 FF 12 34 01 BA 16", ACK), PRM_FAULT)
case("T37 the group is that of the last Set_Prm with lock",
     TO_DATA_EXCH_SF, ASK("68 0C 0C 68 88 82 6D 3D 3E 00 01 01 00 12 34 F0 2A 16", ACK),
     SILENT("68 07 07 68 FF 82 46 3A 3E 20 F0 4F 16"), EXCHANGES,
     ASK("68 0C 0C 68 88 82 6D 3D 3E B0 01 01 00 12 34 F0 DA 16", ACK), CFG_OK, EXCHANGES,
     SILENT("68 07 07 68 FF 82 46 3A 3E 20 10 6F 16"), ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 24 00 02 12 34 F8 16"))
case("T37 user parameters the application refuses are a parameter fault",
     ASK("68 0D 0D 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 80 3B 16", ACK), PRM_FAULT,
     ASK("68 0F 0F 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 01 EF 16", ACK), PRM_FAULT,
     ASK("68 0F 0F 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 C0 00 00 7B 16", ACK), PRM_FAULT)  # DPV1_Enable, Fail_Safe
case("a Set_Prm in DATA_EXCH starts the configuration anew",
     TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), PRM_OK, OUT("00 00"), WAITS_CFG, ASK(DX, RS), CFG_OK, EXCHANGES,
     ASK(DX, DX_OK), OUT("11 22"))

# ---- Chk_Cfg, Get_Cfg: part 8; facts 3.8 ----------------------------------------------------------------------------

case("T38 the real configuration leads to DATA_EXCH", PRM_OK, WAITS_CFG, CFG_OK, EXCHANGES, ASK(DX, DX_OK))
for why, chk_cfg in (
        ("T39 a module is missing", "68 08 08 68 88 82 6D 3E 3E 10 20 10 33 16"),
        ("T39 no module at all", "68 05 05 68 88 82 6D 3E 3E F3 16"),
        ("T40 a module too many", "68 0A 0A 68 88 82 6D 3E 3E 10 20 10 20 10 63 16"),
        ("T40 an empty slot too many", "68 0A 0A 68 88 82 6D 3E 3E 10 20 10 20 00 53 16"),
        ("T41 an empty slot in place of an input", "68 09 09 68 88 82 6D 3E 3E 00 20 10 20 43 16"),
        ("T41 an input in place of an output", "68 09 09 68 88 82 6D 3E 3E 10 20 10 10 43 16"),
        ("T41 the same lengths in another order", "68 09 09 68 88 82 6D 3E 3E 10 10 20 20 53 16"),
        ("T41 outputs first", "68 09 09 68 88 82 6D 3E 3E 20 10 20 10 53 16"),
        ("T41 consistency over all in place of an octet's", "68 09 09 68 88 82 6D 3E 3E 90 20 10 20 D3 16"),
        ("T41 two octets in place of one", "68 09 09 68 88 82 6D 3E 3E 11 20 10 20 54 16"),
        ("T41 a word in place of an octet", "68 09 09 68 88 82 6D 3E 3E 50 20 10 20 93 16"),
        ("T42 special formats, the same lengths", "68 0D 0D 68 88 82 6D 3E 3E 40 00 80 00 40 00 80 00 73 16"),
        ("T43 a special format promises a length that is not there", "68 06 06 68 88 82 6D 3E 3E C0 B3 16"),
        ("T43 a special format promises octets that are not there", "68 07 07 68 88 82 6D 3E 3E 0E 01 02 16"),
        ("T44 the longest of all", "68 F9 F9 68 88 82 6D 3E 3E" + 244 * " 00" + " F3 16")):
    case(f"{why}: a configuration fault, and no Data_Exchange",
         PRM_OK, ASK(chk_cfg, ACK), CFG_FAULT, ASK(DX, RS), PRM_OK, WAITS_CFG)
case("T45 Chk_Cfg in WAIT_PRM is not processed",
     CFG_OK, WAITS_PRM, ASK("68 05 05 68 88 82 6D 3E 3E F3 16", ACK), WAITS_PRM)
case("T45 Chk_Cfg of another master is not processed",
     PRM_OK, ASK("68 09 09 68 88 83 6D 3E 3E 10 20 10 20 54 16", ACK), WAITS_CFG, CFG_OK, EXCHANGES,
     ASK("68 05 05 68 88 83 6D 3E 3E F4 16", ACK), EXCHANGES)
case("T45 Chk_Cfg in DATA_EXCH is checked again",
     TO_DATA_EXCH, ASK(DX, DX_OK), CFG_OK, EXCHANGES, OUT("11 22"), ASK("68 08 08 68 88 82 6D 3E 3E 10 20 10 33 16", ACK),
     OUT("00 00"), CFG_FAULT, ASK(DX, RS))
GET_CFG = ASK("68 05 05 68 88 82 6D 3B 3E F0 16", "68 09 09 68 82 88 08 3E 3B 10 20 10 20 EB 16")
case("T70 Get_Cfg is answered in every state, to anyone, and RR with data",
     GET_CFG, PRM_OK, GET_CFG, CFG_OK, EXCHANGES, GET_CFG,
     ASK("68 05 05 68 88 84 6D 3B 3E F2 16", "68 09 09 68 84 88 08 3E 3B 10 20 10 20 ED 16"),
     ASK("68 06 06 68 88 82 6D 3B 3E 00 F0 16", RR))

# ---- Data_Exchange: part 8; facts 3.6 -------------------------------------------------------------------------------

case("T47 Data_Exchange before parameters and configuration is refused",
     ASK(DX, RS), PRM_OK, ASK(DX, RS), OUT("00 00"))
case("T47 outputs are live without any Global_Control, and inputs follow",
     TO_DATA_EXCH, OUT("00 00"), ASK(DX, DX_OK), OUT("11 22"), IN("1F 01"),
     ASK(DX_33_44, "68 05 05 68 02 08 08 1F 01 32 16"), OUT("33 44"))
for octets, wrong in ((1, "68 04 04 68 08 02 6D 11 88 16"), (3, "68 06 06 68 08 02 6D 11 22 33 DD 16"),
                      (244, "68 F7 F7 68 08 02 6D" + 244 * " 00" + " 77 16")):
    case(f"T48 {octets} outputs in place of 2 are refused and end data exchange",
         TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), ASK(wrong, RS), OUT("00 00"), CFG_FAULT, ASK(DX, RS))
case("T49 no outputs at all is the fail-safe state",
     TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), ASK("10 08 02 6D 77 16", DX_OK), OUT("00 00"), EXCHANGES, ASK(DX, DX_OK),
     OUT("11 22"))
case("T50 Data_Exchange of another master is refused and changes nothing",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK("68 05 05 68 08 03 6D 33 44 EF 16", "10 03 08 03 0E 16"), OUT("11 22"),
     ASK(DX_33_44, DX_OK), OUT("33 44"))

# ---- Slave_Diag: part 8; facts 3.9 ----------------------------------------------------------------------------------

case("T53 Slave_Diag with data is answered RR", ASK("68 06 06 68 88 82 6D 3C 3E 00 F1 16", RR))
case("T54 over-temperature is announced by DH, read, and announced when it goes",
     ASK("68 0E 0E 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 28 E4 16", ACK), CFG_OK, EXCHANGES,  # more than 40 degrees
     ASK(DX, DX_OK), IN("29 00"), ASK(DX, "68 05 05 68 02 08 0A 29 00 3D 16"),
     ASK(DX_33_44, "68 05 05 68 02 08 0A 29 00 3D 16"), OUT("33 44"),
     ASK(GET_DIAG, "68 0D 0D 68 82 88 08 3E 3C 08 04 00 02 12 34 02 01 E3 16"),
     ASK(DX, "68 05 05 68 02 08 08 29 00 3B 16"), IN("28 00"), ASK(DX, "68 05 05 68 02 08 0A 28 00 3C 16"),
     EXCHANGES, ASK(DX, "68 05 05 68 02 08 08 28 00 3A 16"))
case("T58 another master may read the diagnosis without taking the news away",
     ASK("68 0E 0E 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 28 E4 16", ACK), CFG_OK, EXCHANGES,
     IN("29 00"), ASK(DX, "68 05 05 68 02 08 0A 29 00 3D 16"),
     ASK("68 05 05 68 88 83 6D 3C 3E F2 16", "68 0D 0D 68 83 88 08 3E 3C 08 04 00 02 12 34 02 01 E4 16"),
     ASK(DX, "68 05 05 68 02 08 0A 29 00 3D 16"),
     ASK(GET_DIAG, "68 0D 0D 68 82 88 08 3E 3C 08 04 00 02 12 34 02 01 E3 16"),
     ASK(DX, "68 05 05 68 02 08 08 29 00 3B 16"))

# ---- Global_Control to everybody, master 2: part 8; facts 3.11 ------------------------------------------------------

OPERATE = SILENT("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16")
CLEAR = SILENT("68 07 07 68 FF 82 46 3A 3E 02 00 41 16")
UNFREEZE = SILENT("68 07 07 68 FF 82 46 3A 3E 04 00 43 16")
FREEZE = SILENT("68 07 07 68 FF 82 46 3A 3E 08 00 47 16")
UNSYNC = SILENT("68 07 07 68 FF 82 46 3A 3E 10 00 4F 16")
SYNC = SILENT("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16")
IN_SYNC = ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 24 00 02 12 34 F8 16")

case("T59 Sync holds the outputs until the next Sync",
     TO_DATA_EXCH_SF, ASK(DX, DX_OK), SYNC, OUT("11 22"), ASK(DX_33_44, DX_OK), OUT("11 22"), SYNC, OUT("33 44"),
     ASK(DX_55_66, DX_OK), OUT("33 44"))
case("T59 Unsync gives the last outputs and lets the next ones through",
     TO_DATA_EXCH_SF, SYNC, ASK(DX_33_44, DX_OK), OUT("00 00"), UNSYNC, OUT("33 44"), ASK(DX_55_66, DX_OK), OUT("55 66"))
case("T60 Freeze holds the inputs of its moment",
     TO_DATA_EXCH_SF, FREEZE, IN("21 00"), ASK(DX, DX_OK), FREEZE, IN("22 00"), ASK(DX, IN_21), UNFREEZE,
     ASK(DX, "68 05 05 68 02 08 08 22 00 34 16"), IN("23 00"), ASK(DX, "68 05 05 68 02 08 08 23 00 35 16"))
case("T61 Un wins when both bits are set",
     TO_DATA_EXCH_SF, SILENT("68 07 07 68 FF 82 46 3A 3E 3C 00 7B 16"), EXCHANGES,
     SILENT("68 07 07 68 FF 82 46 3A 3E 28 00 67 16"), EXCHANGES_SF, SILENT("68 07 07 68 FF 82 46 3A 3E 3C 00 7B 16"),
     EXCHANGES)
case("T62 Clear sets the outputs to the fail-safe state, and data exchange goes on",
     TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), CLEAR, OUT("00 00"), EXCHANGES, ASK(DX_33_44, DX_OK), OUT("33 44"))
case("T62 Clear reaches outputs under Sync, too",
     TO_DATA_EXCH_SF, ASK(DX, DX_OK), SYNC, ASK(DX_33_44, DX_OK), CLEAR, OUT("00 00"), UNSYNC, OUT("00 00"))
case("T63 Operate changes nothing", TO_DATA_EXCH_SF, ASK(DX, DX_OK), OPERATE, OUT("11 22"), EXCHANGES)
case("T64 only a matching group obeys",
     TO_DATA_EXCH_SF, SILENT("68 07 07 68 FF 82 46 3A 3E 20 02 61 16"), EXCHANGES,
     SILENT("68 07 07 68 FF 82 46 3A 3E 20 FE 5D 16"), EXCHANGES, SILENT("68 07 07 68 FF 82 46 3A 3E 20 03 62 16"), IN_SYNC)
case("T64 a station may be addressed alone",
     TO_DATA_EXCH_SF, SILENT("68 07 07 68 88 82 44 3A 3E 20 00 E6 16"), IN_SYNC,
     SILENT("68 07 07 68 89 82 44 3A 3E 10 00 D7 16"), IN_SYNC)
case("T65 another master has nothing to say",
     TO_DATA_EXCH_SF, ASK(DX, DX_OK), SILENT("68 07 07 68 FF 83 46 3A 3E 22 00 62 16"), OUT("11 22"), EXCHANGES)
case("T65 outside DATA_EXCH it is ignored",
     SYNC, ASK(SET_PRM_SF, ACK), SYNC, CFG_OK, EXCHANGES, ASK(DX, DX_OK), OUT("11 22"))
case("T66 a Global_Control of another length is ignored",
     TO_DATA_EXCH_SF, SILENT("68 06 06 68 FF 82 46 3A 3E 20 5F 16"), SILENT("68 08 08 68 FF 82 46 3A 3E 20 00 00 5F 16"),
     SILENT("68 05 05 68 FF 82 46 3A 3E 3F 16"), EXCHANGES)
case("T66 Sync and Freeze end when data exchange ends",
     TO_DATA_EXCH_SF, SILENT("68 07 07 68 FF 82 46 3A 3E 28 00 67 16"), EXCHANGES_SF, TO_DATA_EXCH_SF, ASK(DX, DX_OK),
     OUT("11 22"))

# ---- RD_Inp, RD_Outp by master 3, class 2: part 8 -------------------------------------------------------------------

RD_INP = "68 05 05 68 88 83 6D 38 3E EE 16"
RD_OUTP = "68 05 05 68 88 83 6D 39 3E EF 16"
NO_OUTPUTS = ASK(RD_OUTP, "68 07 07 68 83 88 08 3E 39 00 00 8A 16")

case("T67 RD_Inp shows the inputs to any master in DATA_EXCH",
     ASK(RD_INP, "10 03 08 03 0E 16"), PRM_OK, ASK(RD_INP, "10 03 08 03 0E 16"), TO_DATA_EXCH,
     ASK(RD_INP, "68 07 07 68 83 88 08 3E 38 1E 00 A7 16"),
     ASK("68 05 05 68 88 82 6D 38 3E ED 16", "68 07 07 68 82 88 08 3E 38 1E 00 A6 16"))
case("T68 RD_Outp shows the outputs to any master in DATA_EXCH",
     ASK(RD_OUTP, "10 03 08 03 0E 16"), TO_DATA_EXCH, NO_OUTPUTS, ASK(DX, DX_OK),
     ASK(RD_OUTP, "68 07 07 68 83 88 08 3E 39 11 22 BD 16"), CLEAR, NO_OUTPUTS)
case("T69 RD_Inp and RD_Outp with data are answered RR",
     TO_DATA_EXCH, ASK("68 06 06 68 88 82 6D 38 3E 00 ED 16", RR), ASK("68 06 06 68 88 82 6D 39 3E 00 EE 16", RR))
case("T85 a second master asks while the first exchanges data",
     TO_DATA_EXCH, ASK(DX, DX_OK), ASK(RD_INP, "68 07 07 68 83 88 08 3E 38 1E 00 A7 16"),
     ASK("68 05 05 68 08 02 5D 33 44 DE 16", DX_OK),
     ASK("68 05 05 68 88 83 6D 3C 3E F2 16", "68 0B 0B 68 83 88 08 3E 3C 00 04 00 02 12 34 D9 16"),
     ASK("68 05 05 68 08 02 7D 55 66 42 16", DX_OK), ASK(RD_OUTP, "68 07 07 68 83 88 08 3E 39 55 66 45 16"), OUT("55 66"))

# ---- Set_Slave_Add: part 8; facts 3.12 ------------------------------------------------------------------------------

UNADDRESSED = [NEW_BATTERY, POWER(126)]
AT_126 = ASK("10 7E 02 49 C9 16", "10 02 7E 00 80 16")
AT_9 = ASK("10 09 02 49 54 16", "10 02 09 00 0B 16")
TO_9 = ASK("68 09 09 68 FE 82 6D 37 3E 09 12 34 00 B1 16", ACK)

case("T05 a station without address answers at 126", UNADDRESSED, AT_126, SILENT(STATUS))
case("T71 a station without address takes the one it is given",
     UNADDRESSED, AT_126, TO_9, AT_9, SILENT("10 7E 02 49 C9 16"),
     ASK("68 05 05 68 89 82 6D 3C 3E F2 16", "68 0B 0B 68 82 89 08 3E 3C 02 05 00 FF 12 34 D9 16"))
case("T71 the address is kept through a power failure and may change again",
     UNADDRESSED, TO_9, POWER(126), AT_9, ASK("68 09 09 68 89 82 6D 37 3E 7D 12 34 00 B0 16", ACK),
     ASK("10 7D 02 49 C8 16", "10 02 7D 00 7F 16"), POWER(126), ASK("10 7D 02 49 C8 16", "10 02 7D 00 7F 16"))
case("T71 the switches go before the stored address", UNADDRESSED, TO_9, POWER(8), STILL_ANSWERS, SILENT("10 09 02 49 54 16"))
case("T71 a station that was given its address exchanges data",
     UNADDRESSED, ASK("68 09 09 68 FE 82 6D 37 3E 08 12 34 00 B0 16", ACK), TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"))
case("T72 it is refused where the address comes from switches",
     ASK("68 09 09 68 88 82 6D 37 3E 09 12 34 00 3B 16", RS), STILL_ANSWERS)
case("T72 with an owner it is not processed",
     UNADDRESSED, ASK("68 09 09 68 FE 82 6D 37 3E 08 12 34 00 B0 16", ACK), PRM_OK,
     ASK("68 09 09 68 88 82 6D 37 3E 09 12 34 00 3B 16", ACK), STILL_ANSWERS, CFG_OK, EXCHANGES,
     ASK("68 09 09 68 88 82 6D 37 3E 09 12 34 00 3B 16", ACK), STILL_ANSWERS, EXCHANGES)
case("T73 a wrong ident, an impossible address or too few octets change nothing",
     UNADDRESSED, ASK("68 09 09 68 FE 82 6D 37 3E 09 12 35 00 B2 16", ACK), AT_126,
     ASK("68 09 09 68 FE 82 6D 37 3E 7E 12 34 00 26 16", ACK), AT_126,
     ASK("68 09 09 68 FE 82 6D 37 3E 7F 12 34 00 27 16", ACK), AT_126,
     ASK("68 08 08 68 FE 82 6D 37 3E 09 12 34 B1 16", ACK), AT_126, POWER(126), AT_126)
case("T73 Rem_Slave_Data is allowed", UNADDRESSED, ASK("A2 FE 82 6D 37 3E 09 12 34 00 00 00 B1 16", ACK), AT_9)
case("T74 No_Add_Chg locks the address, beyond a power failure",
     UNADDRESSED, ASK("68 09 09 68 FE 82 6D 37 3E 09 12 34 01 B2 16", ACK), AT_9,
     ASK("68 09 09 68 89 82 6D 37 3E 0A 12 34 00 3D 16", ACK), AT_9, POWER(126), AT_9,
     ASK("68 09 09 68 89 82 6D 37 3E 0A 12 34 00 3D 16", ACK), AT_9)

# ---- watchdog: part 8; facts 3.13. T_WD = 200 ms --------------------------------------------------------------------

case("T75 the watchdog leads to WAIT_PRM and fail-safe outputs",
     TO_DATA_EXCH_WD, ASK(DX, DX_OK), OUT("11 22"), MS(450), OUT("00 00"), WAITS_PRM, ASK(DX, RS))
case("T77 after expiry anyone may take the station",
     TO_DATA_EXCH_WD, MS(450), ASK("68 0C 0C 68 88 83 6D 3D 3E 80 01 01 00 12 34 01 BC 16", ACK),
     ASK("68 05 05 68 88 83 6D 3C 3E F2 16", "68 0B 0B 68 83 88 08 3E 3C 02 04 00 03 12 34 DC 16"))
case("T79 without watchdog the outputs stay", TO_DATA_EXCH, ASK(DX, DX_OK), MS(450), OUT("11 22"), EXCHANGES)
case("T86 after a power failure in DATA_EXCH outputs are safe and parameters gone",
     TO_DATA_EXCH, ASK(DX, DX_OK), OUT("11 22"), POWER(8), OUT("00 00"), WAITS_PRM, ASK(DX, RS))
