#!/usr/bin/env bash
# Makes the book's figures again, each by the command that stands under it. Takes some minutes, with --long ten more for the
# comparison of detectors. Then look at them.
# The commands run in a folder of their own with plain names: a picture states the command that made it.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo build --release --bin cylwatch --examples
PATH=$root/target/release:$root/target/release/examples:$PATH

# Tutorial: its own commands, as they stand in the chapter
cp -r --parents book/tutorial "$work"
awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' book/src/tutorial.md > "$work/commands"
sed 's/emissivity = 0.9/emissivity = 0.9\nfilm_factor = 1.3/; s/law = "mcadams"/law = "mcadams"\nmultiplier = 0.77/' \
    crates/thermal/presets/vessels/nitrogen-20l.toml > "$work/true.toml"
cd "$work"
bash commands

# README, Monitor
cylwatch simulate nitrogen-20l leak-after-tunnel -o run.csv --plot tunnel.png
cylwatch monitor nitrogen-20l run.csv -o rows.csv --plot monitor.png || [ $? -eq 1 ]

# Identification
cylwatch simulate nitrogen-20l tunnel-winter -o run.csv
cylwatch simulate nitrogen-20l ramp-warm -o other.csv
cylwatch identify run.csv --input shoulder --output gas_mean --validate other.csv --plot identify.png

# Calibration
cylwatch simulate true.toml tunnel-winter -o run.csv
cylwatch simulate true.toml shock-cold -o other.csv --seed 1
cylwatch calibrate nitrogen-20l run.csv --scenario run.csv=tunnel-winter --scenario other.csv=shock-cold \
    --validate other.csv -o calibrated.toml --plot calibrate.png

# Sensor placement
cylwatch place nitrogen-20l --sensors 5 --plot placement.png

# Compare detectors, The problem
leak_masked_by_warming out
cold_night out

# The paper rebuilt, Compare detectors, Validation
cylwatch reproduce

if [ "${1:-}" = --long ]; then
    cylwatch bench-detector --out railway --plot delay.svg
    cp delay.svg "$root/book/src/images/"
fi
cp my-plant/tutorial-*.png {tunnel,monitor,identify,calibrate,placement}.png out/{leak-masked-by-warming,cold-night}.svg \
    out/reproduce/{blowdown-i1,bottle-step,tight-cylinder,figure-4-5-7,figure-6,figure-8,observer-scenario-2}.svg \
    "$root/book/src/images/"
