#!/usr/bin/env python3
"""Measure `cylwatch.monitor` on a pandas frame against the command on the same rows as CSV: a year of 10 s rows by default.

Run it with the Python of an environment that has the package and pandas, as `bindings/python/test` leaves one behind, after
`cargo build --release`. The two take turns; each time of the package is from the frame to the rows in memory, each of the command from a
CSV file to a CSV file. Memory is that of the package's process, frame and pandas included.
"""

import argparse
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cylwatch as cw
import numpy as np
import pandas as pd

ROOT = Path(__file__).resolve().parents[1]
VESSEL = "nitrogen-20l"
YEAR_S = 365.25 * 86400


def frame_of(days: float, step_s: float) -> pd.DataFrame:
    """A tight cylinder through summer, winter, days and nights, read with noise."""
    time_s = np.arange(0, days * 86400, step_s)
    random = np.random.default_rng(1)
    season, day = 2 * np.pi * time_s / YEAR_S, 2 * np.pi * time_s / 86400
    wall_degc = 10 + 12 * np.sin(season) + 5.5 * np.sin(day - 0.3)
    pressure_bar = 200 * (wall_degc + 273.15) / 288.15 * (1 + 0.00016 * (wall_degc - 15))
    noise = random.normal(0, [[0.05], [0.05], [0.02]], (3, len(time_s)))
    return pd.DataFrame({
        "time_s": time_s,
        "shoulder_degc": (wall_degc + noise[0]).round(3),
        "valve_degc": (wall_degc + 0.3 * np.sin(day) + noise[1]).round(3),
        "pressure_bar": (pressure_bar + noise[2]).round(3),
    })


def took(call) -> float:
    begun = time.perf_counter()
    call()
    return time.perf_counter() - begun


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=float, default=365)
    parser.add_argument("--step-s", type=float, default=10)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "cylwatch")
    given = parser.parse_args()
    frame = frame_of(given.days, given.step_s)
    print(f"{len(frame)} rows, a frame of {frame.memory_usage().sum() / 1e6:.0f} MB", flush=True)
    with tempfile.TemporaryDirectory(prefix="cylwatch-year-") as folder:
        frame.to_csv(f"{folder}/log.csv", index=False)
        fill = ["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"]
        command = [given.program.resolve(), "monitor", VESSEL, "log.csv", *fill, "-o", "rows.csv", "-q"]

        def shell() -> None:
            code = subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL).returncode
            if code not in (0, 1, 3):
                sys.exit(f"the command ended with {code}")

        def package() -> None:
            cw.monitor(VESSEL, frame, fill_pressure_bar=200, fill_temperature_degc=15)

        ratios = []
        for _ in range(given.turns):
            ours, theirs = took(package), took(shell)
            ratios.append(ours / theirs)
            print(f"package {ours:.2f} s, command {theirs:.2f} s: {ratios[-1]:.3f}", flush=True)
    memory_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"median {statistics.median(ratios):.3f}; the package's process had {memory_mb:.0f} MB at most")


main()
