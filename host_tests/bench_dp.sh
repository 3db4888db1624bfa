#!/bin/sh
# Instructions of the DP stack, counted by callgrind, simulated port left out: the difference between a run of many
# telegrams and a run of none.
set -eu
bin=${FIELDLING_BIN:-build/posix}
out=build/bench
mkdir -p "$out"
many=1000

# counted FUNCTION[,FUNCTION] PROGRAM ARGUMENTS...: instructions spent in the stack below these functions
counted() {
    toggles=$(echo "$1" | sed 's/^/--toggle-collect=/; s/,/ --toggle-collect=/g')
    shift
    # shellcheck disable=SC2086 # a list
    valgrind --tool=callgrind --callgrind-out-file="$out/callgrind" $toggles "$@" >"$out/log" 2>&1 ||
        { cat "$out/log" >&2; exit 1; }
    callgrind_annotate --auto=no --threshold=100 "$out/callgrind" |
        awk '/firmware\/(phy_uart|fdl|ddlm)\/|firmware\/bytes/ { gsub(",", "", $1); n += $1 } END { print n + 0 }'
}

# per FUNCTIONS PROGRAM WHAT
per() {
    all=$(counted "$1" "$bin/$2" "$3" $many)
    none=$(counted "$1" "$bin/$2" "$3" 0)
    echo $(((all - none) / many))
}

isr=line_octet_isr,line_silence_isr,line_sent_isr
echo "instructions of the stack on this machine ($(uname -m), gcc -O2), average of $many telegrams:"
for size in 2 32; do
    echo "  Data_Exchange of $size octets, first octet in to last octet out: $(per $isr bench-dp-$size exchange)"
    echo "  the same telegram to another station: $(per $isr bench-dp-$size foreign)"
done
