#!/bin/sh
# Several stations and one master on one segment, in real time over pseudo terminals (make run STATIONS=8).
#
# usage: sim/run_stations.sh N [SECONDS]    1 to 14 stations, addresses from 10 on; without SECONDS until Ctrl-C, or
#                                           10 s where the output is no terminal
set -eu
n=$1
seconds=${2:-}
bin=${FIELDLING_BIN:-build/posix}
case $n in '' | *[!0-9]*) n=0 ;; esac
if [ "$n" -lt 1 ] || [ "$n" -gt 14 ]; then
    echo "run_stations: STATIONS is 1 to 14" >&2
    exit 2
fi
[ -n "$seconds" ] || [ -t 1 ] || seconds=10

folder=$(mktemp -d)
running=
clean_up() {
    for process in $running; do kill "$process" 2>/dev/null || true; done
    wait
    rm -rf "$folder"
}
trap clean_up EXIT
trap 'exit 130' INT TERM

lines="$folder/master $folder/tap"
i=1
while [ "$i" -le "$n" ]; do
    lines="$lines $folder/$i"
    i=$((i + 1))
done
# shellcheck disable=SC2086 # a list
"$bin/fieldling-segment" $lines >"$folder/segment.log" &
running=$!
until [ -s "$folder/segment.log" ]; do
    kill -0 "$running" 2>/dev/null || exit 1
    sleep 0.05
done

slaves=
i=1
while [ "$i" -le "$n" ]; do
    address=$((i + 9))
    "$bin/fieldling-dp" --line "$folder/$i" --address "$address" --baud 500000 </dev/null >"$folder/$i.log" 2>&1 &
    running="$running $!"
    slaves="$slaves --slave $address=gsd/FLDL1234.GSD"
    i=$((i + 1))
done
echo "$n stations at 10 to $((n + 9)), one master at 2. To watch: $bin/fieldling-mon $folder/tap"
# shellcheck disable=SC2086 # a list
"$bin/fieldling-master" --line "$folder/master" --slot 100 --count $slaves ${seconds:+--seconds "$seconds"} cyclic
