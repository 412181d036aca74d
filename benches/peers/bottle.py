"""The closed bottle's right-hand side in Python, with properties as polynomials or from CoolProp.

State: wall cells, K, then the gas energy over a constant heat capacity, so that one absolute tolerance in
kelvins holds for all. Between wall and gas `q = c exp(L) (theta^2 + flat^2)^(1/6) theta`, `L = ln k + ln R / 3`
at the film temperature; the surface follows from `G (T_wall - T_s) = A q(T_s)` by Newton's method.
"""

from typing import Any

import numpy as np
from numpy.polynomial import chebyshev, polynomial
from numpy.typing import NDArray

Array = NDArray[np.float64]

DEGREE = 9
FILM_DEGREES = (7, 5)
ITERATIONS = 3
GRAVITY_M_S2 = 9.80665


class Bottle:
    """Matrices and polynomials of one system; polynomials are in `(T - middle) / half width`."""

    def __init__(self, inputs: Any) -> None:
        self.inputs = inputs
        cells = len(inputs["capacity_j_k"])
        low, high = inputs["range_k"]
        self.middle_k, self.half_k = 0.5 * (low + high), 0.5 * (high - low)
        nodes = np.array(inputs["node_k"])
        unit = (nodes - self.middle_k) / self.half_k
        self.scale_j_k = inputs["energy_per_k"]
        energy = np.array(inputs["node_energy_j_kg"]) * inputs["mass_kg"] / self.scale_j_k
        self.energy_middle = 0.5 * (energy[0] + energy[-1])
        self.energy_half = 0.5 * (energy[0] - energy[-1])
        self.temperature = fitted((energy - self.energy_middle) / self.energy_half, unit, DEGREE)
        rows = [fitted(unit, np.array(row), FILM_DEGREES[1]) for row in inputs["node_ln_film"]]
        self.film = np.array([fitted(unit, column, FILM_DEGREES[0]) for column in np.array(rows).T]).T
        self.capacity = np.array(inputs["capacity_j_k"])
        self.conduction = np.zeros((cells, cells))
        for link in inputs["links"]:
            a, b, g = link["a"], link["b"], link["conductance_w_k"]
            self.conduction[[a, b], [a, b]] -= g
            self.conduction[[a, b], [b, a]] += g
        outer = np.zeros(cells)
        for face in inputs["outer"]:
            film = face["area_m2"] * inputs["outside_film_w_m2_k"]
            outer[face["cell"]] += 1 / (1 / film + 1 / face["conductance_w_k"])
        self.conduction -= np.diag(outer)
        self.supply = outer * inputs["air_k"]
        self.inner_cell = np.array([face["cell"] for face in inputs["inner"]])
        self.inner_area = np.array([face["area_m2"] for face in inputs["inner"]])
        self.inner_conductance = np.array([face["conductance_w_k"] for face in inputs["inner"]])
        self.factor, self.flat = inputs["film_factor"], inputs["film_flat_k"]
        self.start = np.append(np.full(cells, inputs["start_k"]), inputs["energy_j"] / self.scale_j_k)

    def gas_k(self, energy: Any) -> Any:
        """Gas temperature of the last state, K."""
        return self.middle_k + self.half_k * polynomial.polyval(
            (energy - self.energy_middle) / self.energy_half, self.temperature
        )

    def rate(self, _t: float, y: Array) -> Array:
        """Right-hand side with polynomials."""
        gas = self.gas_k(y[-1])
        coefficients = self.film @ ((gas - self.middle_k) / self.half_k) ** np.arange(self.film.shape[1])

        def film(film_k: Array) -> Array:
            unit = (film_k - self.middle_k) / self.half_k
            return np.asarray(np.exp(polynomial.polyval(unit, coefficients)))

        return self.balance(y, gas, film)

    def balance(self, y: Array, gas: float, film: Any) -> Array:
        """Heat flows; `film` gives `exp(L)` at film temperatures."""
        node = y[self.inner_cell]
        surface = node
        for _ in range(ITERATIONS):
            theta = surface - gas
            square = theta * theta + self.flat * self.flat
            coefficient = self.inner_area * self.factor * film(0.5 * (surface + gas)) * square ** (1 / 6)
            slope = coefficient * (1 + theta * theta / (3 * square))
            excess = self.inner_conductance * (node - surface) - coefficient * theta
            surface = surface + excess / (self.inner_conductance + slope)
        heat = self.inner_conductance * (node - surface)
        rate = np.empty_like(y)
        flow = self.conduction @ y[:-1] + self.supply
        np.subtract.at(flow, self.inner_cell, heat)
        rate[:-1] = flow / self.capacity
        rate[-1] = heat.sum() / self.scale_j_k
        return rate

    def rate_with_coolprop(self) -> Any:
        """Right-hand side with CoolProp's equation of state and transport properties."""
        import CoolProp.CoolProp as CP

        gas_state, film_state = (CP.AbstractState("HEOS", "Nitrogen") for _ in range(2))
        density, mass = self.inputs["density_kg_m3"], self.inputs["mass_kg"]
        # Energies have other zeros: that of the start is common.
        gas_state.update(CP.DmassT_INPUTS, density, self.inputs["start_k"])
        zero = gas_state.umass() - self.inputs["energy_j"] / mass

        def film(film_k: Array) -> Array:
            values = np.empty_like(film_k)
            for j, t in enumerate(film_k):
                film_state.update(CP.PT_INPUTS, gas_state.p(), t)
                k, mu, rho = film_state.conductivity(), film_state.viscosity(), film_state.rhomass()
                beta = film_state.isobaric_expansion_coefficient()
                rayleigh = GRAVITY_M_S2 * beta * rho * rho * film_state.cpmass() / (mu * k)
                values[j] = k * rayleigh ** (1 / 3)
            return values

        def rate(_t: float, y: Array) -> Array:
            gas_state.update(CP.DmassUmass_INPUTS, density, y[-1] * self.scale_j_k / mass + zero)
            return self.balance(y, gas_state.T(), film)

        return rate


def fitted(x: Array, y: Array, degree: int) -> Array:
    """Polynomial through Chebyshev's basis, as powers: well-behaved on [-1, 1] at these degrees."""
    return np.asarray(chebyshev.cheb2poly(chebyshev.chebfit(x, y, degree)))
