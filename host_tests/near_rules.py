#!/usr/bin/env python3
"""near.py shortens what stays in its page, and nothing else: addresses worked out by hand."""
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "firmware" / "hal" / "mcs51"))
from near import Transfer, choose, listed, main as near  # noqa: E402

# (address, target) of each long one -> the addresses of those made near
CASES = {
    "in the same page": ([(0x0100, 0x0700)], [0x0100]),
    "into another page": ([(0x0100, 0x0900)], []),
    "two octets on it would be in the target's page": ([(0x07FD, 0x0900)], []),
    "the page is that of what comes behind": ([(0x07FE, 0x0900)], [0x07FE]),
    "a target that moves into the page below": ([(0x0100, 0x0200), (0x0300, 0x0800)], [0x0100, 0x0300]),
    # without the first the second one's target would stay where it is, and that is the page above
    "one that another one's change takes out of the page": ([(0x0100, 0x0200), (0x0810, 0x0800)], [0x0100]),
}
LISTING = """\
                                    101 \t.area HOME    (CODE)
      000003 02 01 00         [24]  102 \tljmp\t_f
                                    103 \t.area CSEG    (CODE)
      000100                        104 _f:
                           000007   105 \tar7 = 0x07
      000100 12 01 08         [24]  106 \tlcall\t_g
      000103 02 01 06         [24]  107 \tljmp\t00101$
      000106                        108 00101$:
      000106 E4               [12]  109 \tclr\ta
      000107 22               [24]  110 \tret
      000108                        111 _g:
      000108 02 02 00         [24]  112 \tljmp\t00101$
      00010B 12 03 00         [24]  113 \tlcall\t_elsewhere
      00010E 12 04 00         [24]  114 \tlcall\t_nowhere
      000200                        115 00101$:
"""
LISTED = [(106, 0x100, 0x108), (107, 0x103, 0x106), (112, 0x108, 0x200), (113, 0x10B, 0x300)]
CHECKED = {  # an image linked with one short call: address, target -> exit status
    "a short call in its page": (0x0100, 0x0700, 0),
    "a short call out of its page": (0x0100, 0x0800, 1),
}


def main():
    outcome = {name: [t.at for t in choose([Transfer("", 0, at, "lcall", to) for at, to in pairs])] == wanted
               for name, (pairs, wanted) in CASES.items()}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "x"
        file.with_suffix(".rst").write_text(LISTING)
        found = [(t.line, t.at, t.target) for t in listed(file, {"_elsewhere": 0x300})]
        outcome["a listing: of the code area, labels by function, what is not known left alone"] = found == LISTED
        file.with_suffix(".map").write_text("")
        for name, (at, to, status) in CHECKED.items():
            file.with_suffix(".rst").write_text(
                f"                                    1 \t.area CSEG    (CODE)\n"
                f"      {at:06X} 11 00            [24]    2 \tacall\t_f\n      {to:06X}                          3 _f:\n")
            print(f"expected of '{name}': ", end="", flush=True)
            outcome[name] = near(["--check", str(file.with_suffix(".map")), str(file)]) == status
            print()
    for name, good in outcome.items():
        print(f"{name}:{'PASS' if good else 'FAIL'}")
    failed = list(outcome.values()).count(False)
    print(f"-----------------------\n{len(outcome)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
