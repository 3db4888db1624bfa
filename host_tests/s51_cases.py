"""What dp_cases.py cannot say: times to the machine cycle, counters, lost answers, noise, all bits and all phases.

Each is a function of a Bench (s51_states.py) at power-up with address switches 8; CASES are played by `make test`, LONG
by `make test-long` in addition.
"""
import os
import random

from dp_cases import (CHK_CFG, DX, DX_OK, GET_DIAG, SET_PRM_WD, STATUS, STATUS_OK, STILL_ANSWERS, TO_DATA_EXCH,
                      TO_DATA_EXCH_WD, WAITS_PRM)
from chip import DRIVER, SBUF
from station import expect

CASES, LONG = [], []
LATE_MS = 14  # of the watchdog: its clock's millisecond, the turn that took the last request, the turn that clears up


def case(name, *arguments, into=CASES):
    def keep(function):
        into.append((name, lambda bench: function(bench, *arguments)))
        return function
    return keep


def hexed(octets):
    return octets.hex(" ").upper()


def with_fcs(body):
    """DA SA FC DU... as an SD2."""
    return bytes([0x68, len(body), len(body), 0x68, *body, sum(body) & 0xFF, 0x16])


# ---- watchdog: EN 50170-2 part 8; facts 3.13 ------------------------------------------------------------------------

def set_prm_wd(fact_1, fact_2):
    return hexed(with_fcs(bytes([0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x88, fact_1, fact_2, 0, 0x12, 0x34, 1])))


def expires(bench, fact_1, fact_2):
    """T_WD = 10 ms x f1 x f2 after the end of the owner's last telegram the outputs go safe: not before, and soon after."""
    board = bench.board
    t_wd = 10 * fact_1 * fact_2 * board.cycles_per_ms
    bench.ask(set_prm_wd(fact_1, fact_2), "E5")
    bench.ask(CHK_CFG, "E5")
    bench.ask(DX, DX_OK)
    bench.out("11 22")
    end = board.last_octet_in()
    board.ms(10 * fact_1 * fact_2 + LATE_MS)
    bench.out("00 00")
    safe = [t for t, place, _ in board.written if place == 0][-1] - end
    if not t_wd <= safe <= t_wd + LATE_MS * board.cycles_per_ms:
        raise AssertionError(f"outputs safe after {safe / board.cycles_per_ms:.2f} ms of {10 * fact_1 * fact_2}")
    bench.step(WAITS_PRM)


case("T75 a watchdog of 50 ms expires after T_WD, soon", 1, 5)(expires)
case("T75 a watchdog of 260 ms expires after T_WD, soon", 26, 1)(expires)
case("T75 a watchdog of 2.55 s expires after T_WD, soon", 255, 1, into=LONG)(expires)
case("T75 a watchdog of 25.5 s expires after T_WD, soon", 10, 255, into=LONG)(expires)


@case("T76 telegrams of the owner and retries restart the watchdog, those of others do not")
def restarts(bench):
    bench.steps(TO_DATA_EXCH_WD)  # 200 ms
    retry = "68 05 05 68 08 02 5D 33 44 DE 16", DX_OK
    for request, answer in ((DX, DX_OK), retry, retry, (STATUS, STATUS_OK), (GET_DIAG, None)):
        bench.board.ms(120)
        bench.ask(request, answer)
    bench.out("33 44")
    for _ in range(3):
        bench.board.ms(70)
        bench.ask("68 05 05 68 88 83 6D 3C 3E F2 16", None)  # Slave_Diag by master 3
        bench.ask("68 05 05 68 09 02 6D 11 22 AB 16", "")    # Data_Exchange of station 9
    bench.out("00 00")
    bench.step(WAITS_PRM)


# ---- counters: spec A5 ----------------------------------------------------------------------------------------------

@case("FDL counts what was wrong with a telegram, and what was done")
def counts(bench):
    for name, telegram, answer in (("parity", "10 08! 02 49 53 16", ""), ("parity", "10 08 02 49! 53 16", ""),
                                   ("checksum", "10 08 02 49 54 16", ""), ("format", "10 08 02 49 53 17", ""),
                                   ("format", "68 05 06 68 88 82 6D 3C 3E F1 16", ""), ("gap", "10 08 _40 02 49 53 16", ""),
                                   ("requests", STATUS, STATUS_OK), ("answers", STATUS, STATUS_OK),
                                   ("refused", DX, "10 02 08 03 0D 16"), ("foreign", "10 09 02 49 54 16", "")):
        before = bench.board.counter(name)
        bench.ask(telegram, answer)
        expect(f"{name} after {telegram}", bench.board.counter(name), before + 1)
    before = bench.board.counter("retries")
    for _ in range(2):
        bench.ask("68 05 05 68 88 82 5D 3C 3E E1 16", None)
    expect("retries", bench.board.counter("retries"), before + 1)


# ---- each Data_Exchange exactly once: facts 3.3 ---------------------------------------------------------------------

def exactly_once(bench, n):
    """Requests with a wrong octet and answers that the master has not heard, one in five each: the same telegram again, until
    it is answered and heard. The outputs must have been each number once and in order."""
    board, chance = bench.board, random.Random(n)
    bench.steps(TO_DATA_EXCH)
    del board.written[:]
    fc, repeats = 0x6D, 0
    for number in range(1, n + 1):
        body = bytes([8, 2, fc, number >> 8, number & 0xFF])
        request = hexed(with_fcs(body))
        while True:
            spoil = chance.randrange(1, 11) if chance.randrange(5) == 0 else 0
            words = request.split()
            answer = board.ask(" ".join(w + "!" * (k == spoil) for k, w in enumerate(words, 1)))
            if spoil:
                expect("answer to a telegram with wrong parity", answer, "")
            elif answer:
                expect(request, answer, DX_OK)
            if answer and chance.randrange(5):
                break
            repeats += 1
            if repeats > 3 * n:
                raise AssertionError("no end of retries")
        fc = 0x5D if fc != 0x5D else 0x7D
    high = [value for _, place, value in board.written if place == 0]
    low = [value for _, place, value in board.written if place == 1]
    # FCV is 0 in the first request: repeated, it is executed again
    done = [h << 8 | lo for h, lo in zip(high, low)]
    while done[:2] == [1, 1]:
        del done[0]
    expect("outputs in order", done, list(range(1, n + 1)))


case("T24 each of 25 exchanges is executed once, whatever is lost", 25)(exactly_once)
case("T24 each of 2000 exchanges is executed once, whatever is lost", 2000, into=LONG)(exactly_once)


# ---- noise, bits -----------------------------------------------------------------------------------------------------

def noise(bench, chunks):
    """Random octets, wrong parity among them, random pauses: no answer, and the next good telegram is answered."""
    chance = random.Random(chunks)
    for n in range(chunks):
        if n % 20 == 0:
            bench.step(STILL_ANSWERS)  # or the baud search goes on
        octets = [f"{chance.randrange(256):02X}" for _ in range(chance.randrange(1, 40))]
        octets[chance.randrange(len(octets))] += "!" * chance.randrange(2)
        if len(octets) > 1 and chance.randrange(4) == 0:
            octets.insert(chance.randrange(1, len(octets)), f"_{chance.randrange(1, 60)}")
        bench.ask(" ".join(octets), "")
    bench.step(STILL_ANSWERS)


case("T93 after 20 chunks of noise the next good telegram is answered", 20)(noise)
case("T93 after 1000 chunks of noise the next good telegram is answered", 1000, into=LONG)(noise)


def one_bit(bench, telegram):
    """Each bit of each octet wrong, its parity bit, too: the octet comes with wrong parity. HD 4: nothing is answered."""
    octets = telegram.split()
    bench.step(STILL_ANSWERS)  # or the baud search goes on, and all that follows is played at another rate
    for k, octet in enumerate(octets):
        for bit in range(9):
            wrong = f"{int(octet, 16) ^ (1 << bit & 0xFF):02X}!"
            bench.ask(" ".join([*octets[:k], wrong, *octets[k + 1:]]), "")
        bench.step(STILL_ANSWERS)


def two_bits(bench, telegram):
    """Two data bits of one octet wrong: parity is right, and FCS, ED or LE must tell."""
    octets = telegram.split()
    bench.step(STILL_ANSWERS)  # or the baud search goes on, and all that follows is played at another rate
    for k, octet in enumerate(octets):
        for high in range(8):
            for low in range(high):
                wrong = f"{int(octet, 16) ^ 1 << high ^ 1 << low:02X}"
                bench.ask(" ".join([*octets[:k], wrong, *octets[k + 1:]]), "")
        bench.step(STILL_ANSWERS)


case("one wrong bit, anywhere in an FDL status: no answer", STATUS)(one_bit)
case("one wrong bit, anywhere in a Slave_Diag: no answer", GET_DIAG, into=LONG)(one_bit)
case("two wrong bits in an octet of an FDL status: no answer", STATUS, into=LONG)(two_bits)
case("two wrong bits in an octet of a Slave_Diag: no answer", GET_DIAG, into=LONG)(two_bits)


@case("a telegram that breaks off after any octet is forgotten by the next T_SYN", into=LONG)
def broken_off(bench):
    for telegram in (STATUS, GET_DIAG, "A2 88 82 6D 3E 3E 00 00 00 00 00 00 F3 16", SET_PRM_WD):
        octets = telegram.split()
        for n in range(1, len(octets)):
            bench.ask(" ".join(octets[:n]), "")
            bench.step(STILL_ANSWERS)


# ---- power, address, rate --------------------------------------------------------------------------------------------

@case("T86 the rest of a telegram at power-up is not answered, and the next telegram is")
def starts_in_a_telegram(bench):
    for n in range(1, 6):
        bench.board.power(8)
        bench.ask(" ".join(STATUS.split()[n:]), "")
        bench.step(STILL_ANSWERS)


@case("the driver is never on between power-up and the first answer")
def driver_is_off_until_it_answers(bench):
    board = bench.board
    board.do("reset")
    expect("driver in reset", board.value(DRIVER), 0)
    watch = board.watch_driver()
    board.power(8)
    expect("driver since power-up", {on for kind, on, _ in board.log if kind == "DE"}, {0})
    bench.ask(STATUS, STATUS_OK)
    expect("driver for the answer", [on for kind, on, _ in board.log if kind == "DE"], [1, 0])
    board.do(f"delete {watch}")


@case("T86 power fails in the middle of an answer: the driver is off, and the next telegram is answered")
def stops_in_an_answer(bench):
    board = bench.board
    os.write(board.input, bytes.fromhex(GET_DIAG))
    board.do(*board.until_event(f"sfr w 0x{SBUF:x} 5"))
    expect("driver in an answer", board.value(DRIVER), 1)
    board.power(8)
    expect("driver after power-up", board.value(DRIVER), 0)
    os.read(board.output, 64)
    bench.steps(TO_DATA_EXCH)


def address(bench, n):
    bench.board.new_battery()
    bench.board.power(n)
    bench.ask(f"10 {n:02X} 02 49 {n + 0x4B & 0xFF:02X} 16", f"10 02 {n:02X} 00 {n + 2:02X} 16")
    bench.ask(f"10 {n ^ 64:02X} 02 49 {(n ^ 64) + 0x4B & 0xFF:02X} 16", "")


for switches in range(127):
    case(f"the switches are the address: {switches}", switches, into=CASES if switches in (0, 125, 126) else LONG)(address)


def searches(bench):
    """-> does the rate change within a round of the search?"""
    board = bench.board
    rate = board.value("RCAP2L")
    for _ in range(24):
        board.ms(50)
        if board.value("RCAP2L") != rate:
            return True
    return False


@case("T80 T83 the search ends with a telegram of anybody, and begins again 5 s after the last one to us")
def search(bench):
    board = bench.board
    bench.ask("10 09 02 49 54 16", "")  # a master asks station 9
    expect("searching behind a telegram", searches(bench), False)
    bench.step(STILL_ANSWERS)
    end = board.last_octet_in()
    board.ms(4900)
    expect("divisor 4.9 s after a telegram to us", board.value("RCAP2L"), 256 - board.n)
    expect("searching after that", searches(bench), True)
    if board.now - end < 5000 * board.cycles_per_ms:
        raise AssertionError("Baud_Control ended before 5 s")


@case("T80 without a telegram the search goes through the rates of the board")
def search_goes_on(bench):
    expect("searching", searches(bench), True)


@case("T82 noise is not taken for a rate")
def noise_is_no_rate(bench):
    bench.ask("68 12 E5 10 55 AA! 00 16", "")
    bench.ask("10 09 02 49 55 16", "")
    expect("searching", searches(bench), True)


@case("T83 the search does not end data exchange", into=LONG)
def search_in_data_exchange(bench):
    bench.steps(TO_DATA_EXCH)
    bench.ask(DX, DX_OK)
    bench.board.ms(5100)
    expect("searching", searches(bench), True)
    bench.out("11 22")


# ---- T_SDR -----------------------------------------------------------------------------------------------------------

@case("T36 T84 answers keep the min_T_SDR of Set_Prm, 11 and 60 T_bit")
def min_t_sdr(bench):
    board = bench.board
    for t_bit, prm in ((60, "68 0C 0C 68 88 82 6D 3D 3E 80 01 01 3C 12 34 01 F7 16"),
                       (11, "68 0C 0C 68 88 82 6D 3D 3E 80 01 01 0B 12 34 01 C6 16")):
        bench.ask(prm, "E5")
        for request, answer in ((STATUS, STATUS_OK), (GET_DIAG, None)):
            bench.ask(request, answer)
            turn = board.turn() / board.bit
            if turn < t_bit:
                raise AssertionError(f"an answer after {turn:.1f} T_bit, min_T_SDR is {t_bit}")


@case("T36 somebody who talks when min_T_SDR of 60 T_bit ends is not answered without T_SYN")
def faster(bench):
    """What was silent is T_SDR: FDL status is answered, or not, but never the Slave_Diag so soon behind it."""
    bench.ask("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 3C 12 34 01 F7 16", "E5")
    for t_bit in range(50, 64, 2):
        answer = bench.board.ask(f"{STATUS} _{t_bit} {GET_DIAG}")
        expect(f"{t_bit} T_bit: the first one's answer or none", answer in ("", STATUS_OK), True)


# ---- any phase of the main loop --------------------------------------------------------------------------------------

def phases(bench, step):
    """A request that begins at any moment of a turn of the main loop is answered, at the latest when it is repeated."""
    board = bench.board
    bench.steps(TO_DATA_EXCH)
    begin = board.now
    board.turns(1)
    turn = board.now - begin
    for moment in range(0, turn, step):
        if moment:
            board.do(f"step {moment}")  # instructions: a turn is over before they are
        bench.ask(DX, DX_OK)
        bench.out("11 22")


case("a request at any moment of the main loop's turn is answered", 7, into=LONG)(phases)
