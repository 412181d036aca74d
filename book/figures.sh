#!/usr/bin/env bash
# Makes the book's figures again, each by the command that stands under it. Takes some minutes. Then look at them.
set -euo pipefail
cd "$(dirname "$0")/.."
images=$PWD/book/src/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo build --release
PATH=$PWD/target/release:$PATH

# README, Monitor
cylwatch simulate nitrogen-20l leak-after-tunnel -o "$work/run.csv" --plot "$images/tunnel.png"
cylwatch monitor nitrogen-20l "$work/run.csv" -o "$work/rows.csv" --plot "$images/monitor.png" || [ $? -eq 1 ]

# Identification
cylwatch simulate nitrogen-20l tunnel-winter -o "$work/run.csv"
cylwatch simulate nitrogen-20l ramp-warm -o "$work/other.csv"
(cd "$work" && cylwatch identify run.csv --input shoulder --output gas_mean --validate other.csv --plot "$images/identify.png")

# Calibration
sed 's/emissivity = 0.9/emissivity = 0.9\nfilm_factor = 1.3/; s/law = "mcadams"/law = "mcadams"\nmultiplier = 0.77/' \
    crates/thermal/presets/vessels/nitrogen-20l.toml > "$work/true.toml"
(
    cd "$work"
    cylwatch simulate true.toml tunnel-winter -o run.csv
    cylwatch simulate true.toml shock-cold -o other.csv --seed 1
    cylwatch calibrate nitrogen-20l run.csv --scenario run.csv=tunnel-winter --scenario other.csv=shock-cold \
        --validate other.csv -o calibrated.toml --plot "$images/calibrate.png"
)

# Sensor placement
cylwatch place nitrogen-20l --sensors 5 --plot "$images/placement.png"

# Compare detectors, The problem
for example in leak_masked_by_warming cold_night; do
    cargo run --release --example "$example" -- "$work/out"
done
cp "$work"/out/{leak-masked-by-warming,cold-night}.svg "$images/"

# The paper rebuilt, Compare detectors, Validation
cylwatch reproduce --out "$work/reproduce"
cp "$work"/reproduce/{blowdown-i1,bottle-step,tight-cylinder,figure-4-5-7,figure-6,figure-8,observer-scenario-2}.svg "$images/"

# Tutorial: its own commands, as they stand in the chapter
cp -r --parents book/tutorial "$work"
awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' book/src/tutorial.md > "$work/commands"
(cd "$work" && bash commands)
cp "$work"/my-plant/tutorial-*.png "$images/"
