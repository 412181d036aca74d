#!/usr/bin/env bash
# Makes the logs of a depot for `cylwatch serve --replay`: a week under rail vehicles, a row a minute, of 50 cylinders (or as many as the first argument says)
# in logs/. Every tenth leaks from the third day on, from 2 g/h up; every 25th has a shoulder sensor that slips by 3 K on the fifth day. About a
# second each. Needs cylwatch on the path.
set -euo pipefail
cd "$(dirname "$0")"
count=${1:-50}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p logs
cylwatch init "$work/depot" --scenario railway-week --quiet

one() {
    number=$1 name=$(printf 'N%02d' "$1") scenario=$work/depot/$1.toml
    cp "$work/depot/scenario.toml" "$scenario"
    if ((number % 10 == 0)); then
        printf '\n[[leak]]\nname = "leak"\nflow_g_h = %s\nstart_d = 2\n' "$((number / 5))" >>"$scenario"
    fi
    cylwatch simulate nitrogen-20l "$scenario" --seed "$number" --quiet -o "$work/$name.csv"
    # The columns of a logger alone.
    awk -F, -v slips="$((number % 25 == 7))" '
        /^#/ { next }
        !header { for (i = 1; i <= NF; i++) at[$i] = i; header = 1; print "time_s,shoulder_degc,valve_degc,pressure_bar"; next }
        {
            shoulder = $at["measured_shoulder_degc"]
            if (slips && $at["time_s"] >= 345600) shoulder += 3
            print $at["time_s"] "," shoulder "," $at["measured_valve_degc"] "," $at["measured_pressure_bar"]
        }' "$work/$name.csv" >"logs/$name.csv"
    rm "$work/$name.csv"
}

for ((first = 1; first <= count; first += 4)); do
    for ((number = first; number < first + 4 && number <= count; number++)); do one "$number" & done
    wait
done
echo "logs/ has $count logs of a week"
