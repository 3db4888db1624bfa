#!/usr/bin/env python3
"""drop_stores.py takes out what nobody reads, and nothing else: assembly in, assembly out, worked out by hand."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "firmware" / "hal" / "mcs51"))
from drop_stores import PLACE, Listing, drop_loads, drop_stores  # noqa: E402

S = "mov dptr,#_f_x_65536_1"
OCTET = f"{S} / movx @dptr,a / movx a,@dptr / mov r7,a"
WORD = (f"mov r7,dph / mov a,dpl / {S} / movx @dptr,a / mov a,r7 / inc dptr / movx @dptr,a / "
        f"{S} / movx a,@dptr / mov r6,a / inc dptr / movx a,@dptr / mov r7,a")
CASES = {
    "an octet nobody loads again": (f"{OCTET} / ret", "mov r7,a / ret"),
    "an octet that is loaded later is still stored": (
        f"{OCTET} / {S} / movx a,@dptr / ret", f"{S} / movx @dptr,a / mov r7,a / {S} / movx a,@dptr / ret"),
    "a word nobody loads again": (f"{WORD} / ret", "mov r7,dph / mov a,dpl / mov r6,a / mov a,r7 / ret"),
    "a word whose high octet is wanted elsewhere": (
        f"{WORD[:-8]}mov r5,a / ret", "mov r7,dph / mov a,dpl / mov r6,a / mov a,r7 / mov r5,a / ret"),
    "a word whose low octet would overwrite the high one is left alone": (
        WORD.replace("mov r6,a", "mov r7,a") + " / ret", WORD.replace("mov r6,a", "mov r7,a") + " / ret"),
    "DPTR goes on from the place": (
        f"{OCTET} / inc dptr / movx @dptr,a / ret", f"{S} / movx @dptr,a / mov r7,a / inc dptr / movx @dptr,a / ret"),
    "DPTR is used where a branch leads": (
        f"{OCTET} / jz 00101$ / ret / 00101$: / movx @dptr,a / ret",
        f"{S} / movx @dptr,a / mov r7,a / jz 00101$ / ret / 00101$: / movx @dptr,a / ret"),
    "half of DPTR is set, the other half read": (
        f"{OCTET} / mov dpl,r7 / mov a,dph / ret", f"{S} / movx @dptr,a / mov r7,a / mov dpl,r7 / mov a,dph / ret"),
    "a loop leads back to the store": (
        f"00101$: / {OCTET} / djnz r7,00101$ / ret", "00101$: / mov r7,a / djnz r7,00101$ / ret"),
    "the place is reached by its number, too": (
        f"{OCTET} / mov dptr,#(_f_x_65536_1 + 0x0001) / movx a,@dptr / ret",
        f"{S} / movx @dptr,a / mov r7,a / mov dptr,#(_f_x_65536_1 + 0x0001) / movx a,@dptr / ret"),
    "a static of the file is no local": (
        OCTET.replace("_f_x_65536_1", "_count"), OCTET.replace("_f_x_65536_1", "_count")),
}


def reduced(code):
    lines = ["_f_x_65536_1:", "_f:"] + code.split(" / ")
    listing = Listing("".join(f"{line if line.endswith(':') else chr(9) + line}\n" for line in lines))
    for name in filter(None, map(PLACE.match, listing.code)):
        drop_loads(listing, name[1])
        drop_stores(listing, name[1])
    return " / ".join(listing.code[2:])


def main():
    failed = 0
    for name, (code, wanted) in CASES.items():
        got = reduced(code)
        failed += got != wanted
        print(f"{name}:{'PASS' if got == wanted else 'FAIL: ' + got}")
    print(f"-----------------------\n{len(CASES)} Tests {failed} Failures 0 Ignored")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
