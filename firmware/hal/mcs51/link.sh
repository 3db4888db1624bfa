#!/bin/sh
# One image for an 8052 core: link.sh IMAGE "SOURCES" "DEFAULTS" COMPILER OPTION...
# IMAGE.c/ holds what the compiler made of the sources; IMAGE/ gets the same without the functions nobody calls.
# Defaults go into a library, so that a function of the same name in the sources takes their place.
# It is linked twice: calls and jumps become short ones where the first result shows that they can.
set -e
image=$1
sources=$(for c in $2; do echo "$image/${c%.c}"; done)
defaults=$(for c in $3; do echo "$image/${c%.c}"; done)
rm -rf "$image"
for c in $2 $3; do
    mkdir -p "$image/${c%/*}"
    cp "$image.c/${c%.c}.asm" "$image/${c%.c}.asm"
done
shift 3

assemble_and_link() { # COMPILER OPTION...
    for f in $sources $defaults; do
        sdas8051 -plosgff "$f.rel" "$f.asm"
    done
    rm -f "$image.lib" "$image.map"
    sdar -rc "$image.lib" $(for f in $defaults; do echo "$f.rel"; done)
    out=$("$@" $(for f in $sources; do echo "$f.rel"; done) "$image.lib" -o "$image.ihx" 2>&1) || true
}

python3 firmware/hal/mcs51/strip_unused.py $(for f in $sources; do echo "$f.asm"; done) >"$image.stripped"
python3 firmware/hal/mcs51/tidy $(for f in $sources $defaults; do echo "$f.asm"; done)
assemble_and_link "$@"
if [ -f "$image.map" ]; then
    python3 firmware/hal/mcs51/near.py "$image.map" $sources
    assemble_and_link "$@"
fi
# Anything the linker prints is a failure.
if [ -n "$out" ]; then
    echo "$out"
    rm -f "$image.ihx"
    exit 1
fi
python3 firmware/hal/mcs51/near.py --check "$image.map" $sources || { rm -f "$image.ihx"; exit 1; }
