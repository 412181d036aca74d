"""One right-hand side for scipy, scikit-SUNDAE, CasADi and, where Debian's SUNDIALS is there, CVODE from C.

The Python ones call the right-hand side in NumPy; CasADi evaluates it as a graph with exact derivatives; C
is compiled. All use the same polynomials for the properties, so the equation of state costs them nothing:
that is in their favour.
"""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from bottle import ITERATIONS, Array, Bottle
from stopwatch import Results, main, measure

REFERENCE = 1e-11
FIRST_STEP_S = 0.1
HERE = Path(__file__).parent


class Outcome:
    """Gas temperatures at the samples, and what it took."""

    def __init__(self, gas_k: Array, steps: int | None = None, rates: int | None = None) -> None:
        self.gas_k, self.steps, self.rates = gas_k, steps, rates


def samples(inputs: Any) -> Array:
    count = round(inputs["duration_s"] / inputs["sample_s"])
    return np.linspace(0.0, inputs["duration_s"], count + 1)


def scipy(bottle: Bottle, method: str, rate: Callable[[float, Array], Array]) -> Callable[[float], Outcome]:
    from scipy.integrate import solve_ivp

    times = samples(bottle.inputs)

    def run(tolerance: float) -> Outcome:
        solution = solve_ivp(
            rate,
            (0.0, times[-1]),
            bottle.start,
            method=method,
            t_eval=times,
            rtol=max(tolerance, 3e-14),
            atol=100 * tolerance,
            first_step=FIRST_STEP_S,
        )
        return Outcome(bottle.gas_k(solution.y[-1]), rates=solution.nfev)

    return run


def sundae(bottle: Bottle) -> Callable[[float], Outcome]:
    from sksundae.cvode import CVODE

    times = samples(bottle.inputs)

    def rate(t: float, y: Array, out: Array) -> None:
        out[:] = bottle.rate(t, y)

    def run(tolerance: float) -> Outcome:
        solver = CVODE(rate, method="BDF", rtol=tolerance, atol=100 * tolerance, first_step=FIRST_STEP_S)
        solution = solver.solve(times, bottle.start)
        return Outcome(bottle.gas_k(solution.y[:, -1]), rates=solution.nfev)

    return run


def casadi(bottle: Bottle) -> Callable[[float], Outcome]:
    import casadi as ca

    cells = len(bottle.capacity)
    y = ca.SX.sym("y", cells + 1)

    def polynomial(coefficients: Any, x: Any) -> Any:
        value = 0
        for c in reversed(list(coefficients)):
            value = value * x + c
        return value

    unit = polynomial(bottle.temperature, (y[cells] - bottle.energy_middle) / bottle.energy_half)
    gas = bottle.middle_k + bottle.half_k * unit
    film = [polynomial(row, unit) for row in bottle.film]
    flow = ca.SX(ca.sparsify(ca.DM(bottle.conduction))) @ y[:cells] + bottle.supply
    total = 0
    for cell, area, g in zip(bottle.inner_cell, bottle.inner_area, bottle.inner_conductance):
        node = surface = y[int(cell)]
        for _ in range(ITERATIONS):
            theta = surface - gas
            square = theta**2 + bottle.flat**2
            film_unit = (0.5 * (surface + gas) - bottle.middle_k) / bottle.half_k
            coefficient = area * bottle.factor * ca.exp(polynomial(film, film_unit)) * square ** (1 / 6)
            slope = coefficient * (1 + theta**2 / (3 * square))
            surface = surface + (g * (node - surface) - coefficient * theta) / (g + slope)
        heat = g * (node - surface)
        flow[int(cell)] -= heat
        total += heat
    ode = ca.vertcat(flow / bottle.capacity, total / bottle.scale_j_k)
    times = samples(bottle.inputs)
    made: dict[float, Any] = {}

    def run(tolerance: float) -> Outcome:
        # Building the integrator is set-up, which no side is charged for.
        if tolerance not in made:
            options = {
                "reltol": tolerance,
                "abstol": 100 * tolerance,
                "max_num_steps": 100000,
                "step0": FIRST_STEP_S,
            }
            made[tolerance] = ca.integrator("bottle", "cvodes", {"x": y, "ode": ode}, 0.0, times[1:], options)
        solver = made[tolerance]
        end = np.asarray(solver(x0=bottle.start)["xf"])
        stats = solver.stats()
        gas_k = bottle.gas_k(np.append(bottle.start[-1], end[-1]))
        return Outcome(gas_k, steps=stats.get("nsteps"), rates=stats.get("nfevals"))

    return run


def compiled(folder: Path) -> Path | None:
    """CVODE's driver in C, if gcc and SUNDIALS are there."""
    program = folder / "bottle"
    libraries = [f"-lsundials_{name}" for name in ("cvode", "nvecserial", "sunmatrixdense", "sunlinsoldense")]
    command: list[str | Path] = [
        "gcc",
        "-O3",
        "-march=native",
        "-o",
        program,
        HERE / "bottle.c",
        *libraries,
        "-lm",
    ]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    if done.returncode:
        print("CVODE from C: skipped, gcc does not find SUNDIALS (Debian: libsundials-dev)", file=sys.stderr)
        return None
    return program


def c_rows(bottle: Bottle, program: Path, folder: Path) -> list[Results]:
    """Runs of the C driver: everything it needs as numbers in a text file, one JSON object back."""
    inputs = bottle.inputs
    cells, faces = len(bottle.capacity), len(bottle.inner_cell)
    numbers: list[Any] = [cells, faces, len(bottle.temperature), *bottle.film.shape]
    for values in (bottle.capacity, bottle.conduction, bottle.supply, bottle.inner_cell, bottle.inner_area):
        numbers += list(np.ravel(values))
    numbers += [*bottle.inner_conductance, *bottle.temperature, *np.ravel(bottle.film)]
    numbers += [bottle.middle_k, bottle.half_k, bottle.energy_middle, bottle.energy_half, bottle.scale_j_k]
    numbers += [bottle.factor, bottle.flat, inputs["duration_s"], inputs["sample_s"], *bottle.start]
    numbers += [len(inputs["tolerances"]), *inputs["tolerances"]]
    text = folder / "bottle.txt"
    text.write_text("\n".join(repr(float(number)) for number in numbers), encoding="ascii")
    done = subprocess.run([program, text], capture_output=True, text=True, check=True)
    rows: list[Results] = json.loads(done.stdout)
    return rows


def row(name: str, tolerance: float, outcome: Outcome, exact: Array) -> Results:
    error = float(np.max(np.abs(outcome.gas_k - exact)))
    return {
        "name": name,
        "tolerance": tolerance,
        "error_k": error,
        "steps": outcome.steps,
        "rates": outcome.rates,
    }


def agreement(bottle: Bottle, rate: Callable[[float, Array], Array]) -> dict[str, float]:
    """Largest differences from the other side's derivatives, relative to the largest of their kind."""
    wall, gas = 0.0, 0.0
    for specimen in bottle.inputs["specimens"]:
        y = np.append(specimen["wall_k"], specimen["energy_j"] / bottle.scale_j_k)
        found, theirs = rate(0.0, y), np.array(specimen["wall_k_s"])
        wall = max(wall, float(np.max(np.abs(found[:-1] - theirs)) / np.max(np.abs(theirs))))
        gas = max(gas, abs(found[-1] * bottle.scale_j_k / specimen["energy_w"] - 1))
    return {"wall": wall, "gas": gas}


def system(inputs: Any, first: bool, program: Path | None, folder: Path) -> Results:
    bottle = Bottle(inputs)
    exact = scipy(bottle, "Radau", bottle.rate)(REFERENCE).gas_k
    solvers = {f"scipy {method}": scipy(bottle, method, bottle.rate) for method in ("BDF", "Radau", "LSODA")}
    if importlib.util.find_spec("sksundae"):
        solvers["CVODE by scikit-SUNDAE"] = sundae(bottle)
    if importlib.util.find_spec("casadi"):
        solvers["CVODES by CasADi"] = casadi(bottle)
    rows = []
    for name, run in solvers.items():
        for tolerance in inputs["tolerances"]:
            made = row(name, tolerance, run(tolerance), exact)
            made["time"] = measure(lambda: run(tolerance), repetitions=3)
            rows.append(made)
    if program:
        for found in c_rows(bottle, program, folder):
            outcome = Outcome(bottle.gas_k(np.array(found["energy"])), found["steps"], found["rates"])
            made = row("CVODE from C", found["tolerance"], outcome, exact)
            rows.append(made | {"time": found["time"], "version": found["version"]})
    results: Results = {
        "name": inputs["name"],
        "reference_gas_k": exact.tolist(),
        "polynomials_agree": agreement(bottle, bottle.rate),
        "rate_time": measure(lambda: bottle.rate(0.0, bottle.start)),
        "rows": rows,
    }
    if first and importlib.util.find_spec("CoolProp"):
        rate = bottle.rate_with_coolprop()
        results["coolprop_agrees"] = agreement(bottle, rate)
        results["coolprop_rate_time"] = measure(lambda: rate(0.0, bottle.start))
    return results


def case(inputs: Any, first: bool) -> list[Results]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = compiled(folder)
        return [system(one, first, program, folder) for one in inputs["integration"]]


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    found = {"scipy": "scipy", "scikit-sundae": "sksundae", "casadi": "casadi"}
    main(
        lambda inputs, first: {"systems": case(inputs, first)},
        [package for package, module in found.items() if importlib.util.find_spec(module)],
    )
