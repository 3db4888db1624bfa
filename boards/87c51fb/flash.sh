#!/bin/sh
# usage: flash.sh IMAGE.bin DEVICE    in a universal programmer (TL866II+, T48, T56), with minipro; DEVICE as `minipro -l` names it
set -u
command -v minipro >/dev/null || {
    echo "flash: minipro is not installed (Debian 12 has no package of it); the image is $1" >&2
    exit 1
}
# -s: the part is larger than the image
minipro -p "$2" -s -w "$1" || {
    echo "flash: minipro found no programmer or no $2 in it (its words are above)" >&2
    exit 1
}
