"""CoolProp's nitrogen over a grid of states.

Its low-level interface goes state by state, PropsSI over the whole grid. Of the low-level times, those of
as many calls that compute nothing are taken off: what is left is nearly the library.
"""

from collections.abc import Callable
from typing import Any

import CoolProp.CoolProp as CP
import numpy as np

from stopwatch import Results, Timing, main, measure


def less(timing: Timing, overhead: Timing) -> Timing:
    """Times without what the same number of empty calls takes at best."""
    return {
        key: max(value - overhead["minimum_s"], 0.0) if key.endswith("_s") else value
        for key, value in timing.items()
    }


def over(pairs: list[tuple[float, float]], one: Callable[[float, float], object]) -> Callable[[], None]:
    def run() -> None:
        for a, b in pairs:
            one(a, b)

    return run


def case(inputs: Any, first: bool) -> Results:
    del first
    inputs = inputs["properties"]
    temperature, pressure, density = (
        inputs[name] for name in ("temperature_k", "pressure_pa", "density_kg_m3")
    )
    states, dense = list(zip(pressure, temperature)), list(zip(density, temperature))
    gas = CP.AbstractState("HEOS", "Nitrogen")
    update, pt, dt, nothing = gas.update, CP.PT_INPUTS, CP.DmassT_INPUTS, gas.gas_constant

    def pressure_of(rho: float, t: float) -> float:
        update(dt, rho, t)
        return float(gas.p())

    def density_of(p: float, t: float) -> float:
        update(pt, p, t)
        return float(gas.rhomass())

    def all_of(p: float, t: float) -> list[float]:
        update(pt, p, t)
        return [gas.rhomass(), gas.cpmass(), gas.cvmass(), gas.viscosity(), gas.conductivity()]

    def two_calls(a: float, b: float) -> float:
        nothing()
        return float(nothing())

    def six_calls(a: float, b: float) -> list[float]:
        nothing()
        return [nothing(), nothing(), nothing(), nothing(), nothing()]

    def fastest(run: Callable[[], None], empty: Timing) -> Timing:
        """With the phase left to be found, and with the phase said; whichever is faster."""
        timings = []
        for phase in (CP.iphase_not_imposed, CP.iphase_supercritical_gas):
            gas.specify_phase(phase)
            timings.append(measure(run, parts=count))
        gas.unspecify_phase()
        return less(min(timings, key=lambda timing: timing["minimum_s"]), empty)

    count = len(states)
    values = np.array([all_of(p, t) for p, t in states]).T
    two, six = (measure(over(states, one), parts=count) for one in (two_calls, six_calls))
    t, p, rho = np.array(temperature), np.array(pressure), np.array(density)
    props = CP.PropsSI
    names = ["D", "C", "O", "V", "L"]
    return {
        "pressure_pa": [pressure_of(rho, t) for rho, t in dense],
        "density_kg_m3": values[0].tolist(),
        "cp_j_kg_k": values[1].tolist(),
        "cv_j_kg_k": values[2].tolist(),
        "viscosity_pa_s": values[3].tolist(),
        "conductivity_w_m_k": values[4].tolist(),
        "pressure_time": fastest(over(dense, pressure_of), two),
        "density_time": fastest(over(states, density_of), two),
        "all_time": fastest(over(states, all_of), six),
        "overhead_time": two,
        "bulk_pressure_time": measure(lambda: props("P", "T", t, "D", rho, "Nitrogen"), parts=count),
        "bulk_density_time": measure(lambda: props("D", "T", t, "P", p, "Nitrogen"), parts=count),
        "bulk_all_time": measure(
            lambda: [props(name, "T", t, "P", p, "Nitrogen") for name in names], parts=count
        ),
    }


if __name__ == "__main__":
    main(case, ["CoolProp"])
