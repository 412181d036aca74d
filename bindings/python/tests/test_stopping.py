"""Ctrl-C ends every call, wherever it is, and other threads run meanwhile."""

import tomllib

import cylwatch as cw
import numpy as np
import pandas as pd
import pytest
from conftest import ROOT, VESSEL, interrupted, readings, turns_during


def fine_vessel():
    """The 20 L cylinder with so many cells that a calibration takes a minute."""
    vessel = tomllib.loads((ROOT / "vessels" / f"{VESSEL}.toml").read_text())
    vessel["geometry"]["cylinder_cells"] = 60
    vessel["layer"][0]["cells"] = 10
    return vessel


def long_log(rows):
    """A temperature that follows another one, with noise on both."""
    noise = np.random.default_rng(3).normal(0, 0.3, (2, rows))
    time_s = 10.0 * np.arange(rows)
    return {"time_s": time_s, "shoulder_degc": 15 + 5 * np.sin(time_s / 900) + noise[0], "valve_degc": 15 + 4 * np.sin(time_s / 900 - 0.5) + noise[1]}


def calibration():
    rows = pd.DataFrame.from_arrow(cw.simulate(VESSEL, "tunnel-winter").rows)
    log, vessel = readings(rows), fine_vessel()
    return lambda: cw.calibrate(vessel, log, scenario="tunnel-winter")


def identification():
    log = long_log(200_000)
    return lambda: cw.identify(log, "shoulder", "valve", order=3, method="maximum-likelihood", input_sd_k=0.3, output_sd_k=0.3)


def week():
    scenario = tomllib.loads((ROOT / "scenarios" / "shock-cold.toml").read_text())
    vessel = fine_vessel()
    return lambda: cw.simulate(vessel, scenario | {"duration_h": 3000}, relative_tolerance=1e-11)


CALLS = {
    "calibrate": calibration,
    "identify": identification,
    "place": lambda: lambda: cw.place(VESSEL, sensors=5),
    "simulate": week,
}


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_ends_a_call(name):
    call = CALLS[name]()
    took = interrupted(call, after_s=1.0)
    assert 1.0 <= took < 6.0, f"{name} ended {took:.1f} s after it began"
    # The next call does not know of it.
    assert cw.simulate(VESSEL, "shock-cold").exit_code == 0


def test_other_threads_run_during_a_search():
    log = readings(pd.DataFrame.from_arrow(cw.simulate(VESSEL, "tunnel-winter").rows))
    assert turns_during(lambda: cw.calibrate(VESSEL, log, scenario="tunnel-winter")) > 50
