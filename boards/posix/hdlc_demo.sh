#!/bin/sh
# make run PROTOCOL=hdlc: four remote modules and their master station on one line of bits at 7200 bit/s.
# With a terminal: full screen until quit. Without: ten seconds of events, a control command, and status 0 if all
# four modules were online and carried it out.
set -eu
bin=${FIELDLING_BIN:-build/posix}
dir=$(mktemp -d)
pids=

end() {
    for pid in $pids; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    rm -rf "$dir"
}
trap end EXIT
trap 'exit 130' INT TERM

module() { # TYPE ADDRESS
    "$bin/fieldling-hdlc" --line "pty:$dir/$1" --type "$1" --address "$2" </dev/null >"$dir/$1.log" 2>&1 &
    pids="$pids $!"
}
module di 1
module do 2
module ai 3
module ao 4
"$bin/fieldling-hdlc-cable" --ends "$dir/di,$dir/do,$dir/ai,$dir/ao,$dir/master" &
pids="$pids $!"

if [ -t 0 ] && [ -t 1 ] && [ -z "${HDLC_DEMO_BATCH:-}" ]; then
    "$bin/fieldling-hdlc-master" --line "pty:$dir/master" --config boards/posix/hdlc_demo.conf || [ $? = 1 ]
    exit 0
fi
status=0
printf '%s\n' 'wait 3000' 'set pumps 5 1' 'set valves 2 2048' 'set pumps 16 1' 'get switches 0' 'samples levels 1' 'diag pumps' |
    "$bin/fieldling-hdlc-master" --line "pty:$dir/master" --config boards/posix/hdlc_demo.conf --batch 10 \
        >"$dir/out" || status=$?
cat "$dir/out"
grep -q 'event=control module=pumps channel=5 outcome=done value=1' "$dir/out"
grep -q 'event=control module=valves channel=2 outcome=done value=2048' "$dir/out"
exit $status
