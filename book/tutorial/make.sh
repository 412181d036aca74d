#!/usr/bin/env bash
# Makes the log of the tutorial, logger.csv: a simulated cylinder that the user does not know, read by sensors with errors, written
# as a German logger writes. Needs cylwatch on the path, and awk.
set -euo pipefail
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp true-cylinder.toml what-happened.toml "$work"

# Air of an unheated depot over three weeks, a value every 10 min: rest, then weather, days, and a gate that opens now and then.
awk '
function uniform() { seed = (16807 * seed) % 2147483647; return seed / 2147483647 }
function normal() { return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform()) }
BEGIN {
    seed = 20260112
    print "time_h,air_degc"
    for (n = 0; n <= 21 * 144; n++) {
        hour = n / 6
        weather = n ? 0.9966 * weather + 0.247 * normal() : 0
        if (hour % 24 == 0) swing = 3 + 3 * uniform()
        if (uniform() < 1 / 60) open = 3 + int(6 * uniform())
        gate = open-- > 0 ? 0.7 * gate - 1.8 : 0.7 * gate
        on = hour < 4 ? 0 : (hour < 8 ? (hour - 4) / 4 : 1)
        printf "%.4f,%.3f\n", hour, 6 + on * (weather + swing * cos(6.283185307179586 * (hour - 9) / 24) + gate)
    }
}' > "$work/air.csv"

cylwatch simulate "$work/true-cylinder.toml" "$work/what-happened.toml" --seed 50 --quiet -o "$work/run.csv"

# Semicolons, decimal commas, dates, one decimal; the logger was off for a while, and a cell now and then is a dash.
awk -F, '
function german(x) { x = sprintf("%.1f", x); sub(/\./, ",", x); return x }
/^#/ { next }
!header { for (i = 1; i <= NF; i++) at[$i] = i; header = 1
    print "# Datenlogger DL-4, Halle 2, Flasche N2 50 l"
    print "Zeit;T Schulter;T Ventil;T Luft;Druck (Ueberdruck)"; next }
{
    minute = int($at["time_s"] / 60 + 0.5)
    row++
    if (row > 1500 && row <= 1530) next
    printf "2026-%02d-%02d %02d:%02d:00", minute < 28800 ? 1 : 2, minute < 28800 ? 12 + int(minute / 1440) : int((minute - 28800) / 1440) + 1, int(minute / 60) % 24, minute % 60
    split("shoulder valve ambient", names, " ")
    for (i = 1; i <= 3; i++) { x = $at["measured_" names[i] "_degc"]; printf ";%s", x == "" ? "---" : german(x) }
    x = $at["measured_pressure_bar"]
    printf ";%s\n", x == "" ? "---" : german(x - 1.01325)
}' "$work/run.csv" > logger.csv
