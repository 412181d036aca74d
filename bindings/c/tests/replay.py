"""The day of replay.c in Python, row by row with a restore in the middle: the columns of rows.csv must have the same bits."""
import csv
import math

import cylwatch as cw

FILL = {"fill_pressure_bar": 200, "fill_temperature_degc": 15}


def bits(value):
    return "nan" if value is None or math.isnan(value) else value.hex()


steps, rows = cw.Monitor("nitrogen-20l", **FILL), []
log = list(csv.DictReader(open("log.csv")))
for at, row in enumerate(log):
    if at == len(log) // 2:
        state = steps.save()
        steps = cw.Monitor("nitrogen-20l", **FILL)
        steps.restore(state)
    readings = {name: float(cell) if cell else None for name, cell in row.items()}
    rows += steps.step(readings.pop("time_s"), readings)["rows"]
rows += steps.finish()["rows"]
ours = [[bits(row[name]) for name in ("time_s", "mass_kg", "gas_mean_sd_k", "leak_probability")] for row in rows]
theirs = [[bits(float.fromhex(cell)) for cell in row] for row in csv.reader(open("rows.csv"))]
assert len(ours) == len(theirs), (len(ours), len(theirs))
differ = [at for at, pair in enumerate(zip(ours, theirs)) if pair[0] != pair[1]]
assert not differ, f"{len(differ)} rows differ, the first {ours[differ[0]]} from {theirs[differ[0]]}"
print(f"{len(ours)} rows of Python are the same")
