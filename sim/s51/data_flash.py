"""The data flash of an STC89 beside the simulator s51, which has none: in-application programming played by the simulator
itself, at the instruction that triggers it.

The sector at 8000h is kept in the simulator's external RAM from KEPT on, where the part has none. What the part demands is
demanded here: ISP_CONTR enabled with no wait states (20 to 40 MHz), the trigger 46h and then B9h with interrupts off, a
command, an address in the sector; programming only clears bits. Anything else has no effect. The time it takes is not played.
"""
KEPT, SECTOR = 0xC000, 512
DATA, HIGH, LOW, COMMAND, TRIGGER, CONTROL = 0xE2, 0xE3, 0xE4, 0xE5, 0xE6, 0xE7
EA = "(IE>>7)"


def sfr(address):
    return f"sfr[0x{address:x}]"


def play(chip):
    """From now on. chip: a Chip. The flash is erased."""
    at = f"xram[0x{KEPT:x}+(({sfr(HIGH)}&1)<<8)+{sfr(LOW)}]"
    triggered = (f"(before==0x46)&&({sfr(TRIGGER)}==0xb9)&&({sfr(CONTROL)}==0x80)&&(({sfr(HIGH)}&0xfe)==0x80)"
                 f"&&({EA}==0)")
    chip.command("var before\nvar command\nvar erase\nvar erases\nvar operations\n"
                 "before=0\ncommand=0\nerase=0\nerases=0\noperations=0")
    chip.watch(f"sfr w 0x{TRIGGER:x}",
               f"command=({triggered})?{sfr(COMMAND)}:0;before={sfr(TRIGGER)};operations=operations+(command!=0);"
               f"{sfr(DATA)}=(command==1)?{at}:{sfr(DATA)};{at}=(command==2)?({at}&{sfr(DATA)}):{at};"
               "erase=erase|(command==3)")
    chip.watch(f"sfr w 0x{CONTROL:x} 1 if erase==1", f"erase=0;erases=erases+1;{blank()}")
    chip.command(blank())


def blank():
    """What the simulator is told to erase the sector."""
    return f"fill xram 0x{KEPT:x} 0x{KEPT + SECTOR - 1:x} 0xff"
