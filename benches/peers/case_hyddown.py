"""HydDown on the measured blowdown I1 and on the closed bottle.

Its inputs are those that the project publishes for this run, written anew; the bottle is the one of the
preset.
"""

import contextlib
import io
import math
import time
from typing import Any

import numpy as np
from hyddown import HydDown

from stopwatch import Results, main, measure, quartiles

BOTTLE_STEPS_S = [10.0, 60.0, 120.0]
FINE_STEPS_S = (4.0, 2.0)
# A run that takes longer is timed once.
LONG_S = 5.0


def blowdown(inputs: Any) -> dict[str, Any]:
    return {
        "vessel": {
            "length": 1.524,
            "diameter": 0.273,
            "thickness": 0.025,
            "heat_capacity": 500,
            "density": 7800.0,
            "orientation": "vertical",
        },
        "initial": {"temperature": 288.0, "pressure": 150e5, "fluid": "N2"},
        "calculation": {
            "type": "energybalance",
            "time_step": 0.05,
            "end_time": inputs["blowdown_duration_s"],
        },
        "valve": {
            "flow": "discharge",
            "type": "orifice",
            "diameter": 0.00635,
            "discharge_coef": inputs["discharge_coefficient"],
            "back_pressure": 101300.0,
        },
        "heat_transfer": {"type": "specified_h", "temp_ambient": 288.0, "h_outer": 5, "h_inner": "calc"},
    }


def resolved(problem: dict[str, Any]) -> dict[str, Any]:
    """The same with HydDown's one-dimensional wall."""
    return problem | {"vessel": problem["vessel"] | {"thermal_conductivity": 45}}


def bottle(step_s: float) -> dict[str, Any]:
    return {
        "vessel": {
            "length": 0.70,
            "diameter": 0.1907,
            "thickness": 0.0067,
            "heat_capacity": 470,
            "density": 7850.0,
            "orientation": "vertical",
        },
        "initial": {"temperature": 288.15, "pressure": 200e5, "fluid": "N2"},
        "calculation": {"type": "energybalance", "time_step": step_s, "end_time": 21600.0 + step_s},
        "valve": {"flow": "discharge", "type": "mdot", "mdot": 0.0, "back_pressure": 101300.0},
        "heat_transfer": {
            "type": "specified_h",
            "temp_ambient": 308.15,
            "h_outer": 8,
            "h_inner": "calc",
        },
    }


def run(problem: dict[str, Any]) -> Any:
    with contextlib.redirect_stdout(io.StringIO()):
        model = HydDown(problem)
        model.run()
    return model


def rms(times: Any, model: Any, points: Any) -> tuple[float, float]:
    """Root mean square and mean of model minus measurement, at the measured points."""
    error = np.interp(points["time_s"], times, model) - np.array(points["value"])
    return float(np.sqrt(np.mean(error**2))), float(np.mean(error))


def scored(inputs: Any, problem: dict[str, Any], name: str) -> Results:
    start = time.process_time()
    model = run(problem)
    once = time.process_time() - start
    times = model.time_array
    wall = model.T_inner_wall if "thermal_conductivity" in problem["vessel"] else model.T_vessel
    gas, bias = rms(times, model.T_fluid, inputs["gas_middle_k"])
    return {
        "name": name,
        "steps": len(times),
        "gas_rms_k": gas,
        "gas_bias_k": bias,
        "wall_rms_k": rms(times, wall, inputs["wall_high_k"])[0],
        "pressure_rms_bar": rms(times, np.array(model.P) / 1e5, inputs["pressure_bar"])[0],
        "time": quartiles([once]) if once > LONG_S else measure(lambda: run(problem), repetitions=2),
    }


def ends(model: Any, air_k: float) -> tuple[float, float, float]:
    """Gas temperature, K, and pressure, bar, after 6 h, and time to 63 % of the step, s."""
    times, gas = np.array(model.time_array), np.array(model.T_fluid)
    level = gas[0] + (1 - math.exp(-1)) * (air_k - gas[0])
    pressure = np.interp(21600.0, times, np.array(model.P)) / 1e5
    return float(np.interp(21600.0, times, gas)), float(pressure), float(np.interp(level, gas, times))


def bottles(air_k: float, first: bool) -> list[Results]:
    # Euler's error is proportional to the step: two runs give the limit.
    fine, finest = (
        (ends(run(bottle(step_s)), air_k) for step_s in FINE_STEPS_S) if first else ((0.0,) * 3,) * 2
    )
    limit = [2 * b - a for a, b in zip(fine, finest)]
    rows = []
    for step_s in BOTTLE_STEPS_S:
        problem = bottle(step_s)
        gas_k, pressure_bar, time_63_s = ends(run(problem), air_k)
        rows.append(
            {
                "step_s": step_s,
                "gas_k": gas_k,
                "pressure_bar": pressure_bar,
                "time_63_s": time_63_s,
                "pressure_error_bar": pressure_bar - limit[1],
                "time_63_error_s": time_63_s - limit[2],
                "time": measure(lambda: run(problem), repetitions=2),
            }
        )
    return rows


def case(inputs: Any, first: bool) -> Results:
    inputs = inputs["vessels"]
    problem = blowdown(inputs)
    runs = [scored(inputs, problem, "one wall node")]
    if first:
        runs.append(scored(inputs, resolved(problem), "one-dimensional wall, 11 nodes"))
    return {
        "blowdown": runs,
        "bottle": bottles(inputs["bottle_air_k"], first),
    }


if __name__ == "__main__":
    main(case, ["hyddown", "CoolProp"])
