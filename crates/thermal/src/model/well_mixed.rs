//! The gas as one well-mixed node of mass `m` and internal energy `U` in the elastic volume
//! `V = V_0 [1 + a (T_w - T_0) + b (p - p_0)]`.
//!
//! `dm/dt = sum m_in - sum m_out`, `dU/dt = Q + sum m_in h_in - sum m_out h - p dV/dt`. Temperature and volume follow
//! from `u(m/V, T) = U/m` and the volume law by Newton's method in two unknowns; with their slopes by the implicit
//! function theorem, one evaluation in dual numbers gives all first derivatives exactly. With `dV = V_m dm + V_U dU + V_T dT_w` the energy balance is explicit:
//! `dU/dt = [Q + H - p (V_m dm/dt + V_T dT_w/dt)] / (1 + p V_U)`.
use std::cell::Cell;

use super::boundary::Boundary;
use super::node::{Node, Rates};
use crate::ThermalError;
use crate::fluid::{Fluid, Real, State};
use crate::vessel::InnerVolume;

const MAX_ITERATIONS: usize = 60;
/// Relative length of the last Newton step; the error after it is about its square, a rounding.
const TOLERANCE: f64 = 1e-8;
/// Relative change over which the slopes of the last solution may lead to the next one.
const WARM_START_RANGE: f64 = 0.05;

/// The well-mixed gas of one vessel.
#[derive(Debug)]
pub(super) struct WellMixed {
    fluid: Fluid,
    volume: InnerVolume,
    /// Temperature at which the first solution is sought, K.
    start_k: f64,
    /// Last solution that is a gas: the answer to the same question, else it leads to where Newton starts, without influence on where that ends.
    last: Cell<Option<Solved>>,
}

/// A node with what it solves.
#[derive(Clone, Copy, Debug)]
struct Solved {
    /// Mass, kg, energy, J, and temperature of the wall, K.
    inputs: [f64; 3],
    node: Node<f64>,
    /// Derivatives of the temperature with the inputs.
    temperature_by: [f64; 3],
}

impl Solved {
    /// Volume, m³, and temperature, K, for other inputs, to first order.
    fn along<D: Real>(&self, inputs: [D; 3]) -> (D, D) {
        let lift = |value: f64, by: [f64; 3]| {
            (0..3).fold(D::from(value), |sum, i| sum + (inputs[i] - self.inputs[i]) * by[i])
        };
        let node = &self.node;
        (lift(node.volume_m3, node.volume_by), lift(node.state.temperature_k, self.temperature_by))
    }
}

impl WellMixed {
    /// A node of a fluid in a volume, started near a temperature.
    pub(crate) fn new(fluid: Fluid, volume: InnerVolume, temperature_k: f64) -> Self {
        Self { fluid, volume, start_k: temperature_k, last: Cell::new(None) }
    }

    /// The fluid.
    pub(crate) fn fluid(&self) -> &Fluid {
        &self.fluid
    }

    /// State from mass, energy and mean wall temperature.
    ///
    /// # Errors
    /// No temperature gives this energy at this density.
    pub(crate) fn node(&self, mass_kg: f64, energy_j: f64, wall_k: f64) -> Result<Node<f64>, ThermalError> {
        Ok(self.solved([mass_kg, energy_j, wall_k])?.node)
    }

    /// The same with first derivatives.
    ///
    /// # Errors
    /// As [`WellMixed::node`].
    pub(crate) fn differentiated<D: Real>(
        &self,
        mass_kg: D,
        energy_j: D,
        wall_k: D,
    ) -> Result<Node<D>, ThermalError> {
        let inputs = [mass_kg, energy_j, wall_k];
        let (volume, temperature) = self.solved(inputs.map(|input| input.re()))?.along(inputs);
        Ok(self.node_at(inputs, volume, temperature).0)
    }

    fn solved(&self, inputs: [f64; 3]) -> Result<Solved, ThermalError> {
        if let Some(last) = self.last.get().filter(|last| last.inputs == inputs) {
            return Ok(last);
        }
        let (v, t) = self.solve(inputs)?;
        let (node, temperature_by) = self.node_at(inputs, v, t);
        let solved = Solved { inputs, node, temperature_by };
        // Between the phases an energy has more than one temperature. A trial of the solver may land there; what follows must not.
        let state = &node.state;
        let domain = self.fluid.domain();
        let is_gas = state.temperature_k > domain.critical_temperature_k
            && state.pressure_pa <= domain.highest_pressure_pa
            || self.fluid.check(state.density_kg_m3, state.temperature_k).is_ok();
        if is_gas {
            self.last.set(Some(solved));
        }
        Ok(solved)
    }

    /// The node at its solution, and the derivatives of its temperature with the inputs.
    fn node_at<D: Real>(&self, inputs: [D; 3], volume_m3: D, temperature_k: D) -> (Node<D>, [D; 3]) {
        let at = self.linearise(inputs, volume_m3, temperature_k);
        let (v0, a, b) = self.coefficients();
        let state = at.state;
        let energy_per_mass = state.internal_energy_j_kg + state.density_kg_m3 * at.u_rho;
        let pressure_per_mass = state.dp_drho_pa_m3_kg / volume_m3;
        // Implicit function theorem on (F1, F2), rows as in `linearise`.
        let by_input = [
            [energy_per_mass, pressure_per_mass * (-v0 * b)],
            [D::from(-1.0), D::from(0.0)],
            [D::from(0.0), D::from(-v0 * a)],
        ]
        .map(|slope| at.solve(slope).map(|x| -x));
        (Node { state, volume_m3, volume_by: by_input.map(|by| by[0]) }, by_input.map(|by| by[1]))
    }

    fn coefficients(&self) -> (f64, f64, f64) {
        let v = &self.volume;
        (v.volume_m3, v.thermal_expansion_per_k, v.pressure_expansion_per_pa)
    }

    fn linearise<D: Real>(&self, [m, energy, wall_k]: [D; 3], v: D, t: D) -> Linearised<D> {
        let (v0, a, b) = self.coefficients();
        let state = self.fluid.state(m / v, t);
        let rho = state.density_kg_m3;
        let u_rho = (state.pressure_pa - t * state.dp_dt_pa_k) / (rho * rho);
        let stretch = (wall_k - self.volume.reference_temperature_k) * a
            + (state.pressure_pa - self.volume.reference_pressure_pa) * b
            + 1.0;
        Linearised {
            residual: [m * state.internal_energy_j_kg - energy, v - stretch * v0],
            jacobian: [
                [-(u_rho * rho * rho), m * state.cv_j_kg_k],
                [state.dp_drho_pa_m3_kg * rho / v * (v0 * b) + 1.0, state.dp_dt_pa_k * (-v0 * b)],
            ],
            state,
            u_rho,
        }
    }

    fn solve(&self, inputs: [f64; 3]) -> Result<(f64, f64), ThermalError> {
        let [m, energy, _] = inputs;
        let (mut v, mut t) = self.start(inputs);
        if m > 0.0 && m.is_finite() && energy.is_finite() {
            for _ in 0..MAX_ITERATIONS {
                let at = self.linearise(inputs, v, t);
                let [dv, dt] = at.solve(at.residual);
                // Never leave the positive quadrant, never jump by more than a third.
                v -= dv.clamp(-0.3 * v, 0.3 * v);
                t -= dt.clamp(-0.3 * t, 0.3 * t);
                if !(v.is_finite() && t.is_finite()) {
                    break;
                }
                if dv.abs() <= TOLERANCE * v && dt.abs() <= TOLERANCE * t {
                    return Ok((v, t));
                }
            }
        }
        Err(ThermalError::NoGasState { mass_kg: m, energy_j: energy })
    }

    /// Where Newton starts: along the slopes of the last solution, if that does not lead far; else no colder than at the beginning, since
    /// from the warm side it finds the gas and not what the equation of state has between the phases.
    fn start(&self, inputs: [f64; 3]) -> (f64, f64) {
        let Some(last) = self.last.get() else { return (self.volume.volume_m3, self.start_k) };
        let from = (last.node.volume_m3, last.node.state.temperature_k);
        let to = last.along(inputs);
        let is_near = |to: f64, from: f64| (to - from).abs() <= WARM_START_RANGE * from;
        if is_near(inputs[0], last.inputs[0]) && is_near(to.0, from.0) && is_near(to.1, from.1) {
            to
        } else {
            (from.0, from.1.max(self.start_k))
        }
    }

    /// Rates of change for a heat flow from the wall and a rate of change of the mean wall temperature.
    ///
    /// # Errors
    /// An orifice without a throat state.
    pub(crate) fn rates<D: Real>(
        &self,
        node: &Node<D>,
        boundary: &Boundary<'_>,
        heat_w: D,
        wall_rate_k_s: D,
    ) -> Result<Rates<D>, ThermalError> {
        let exchange = boundary.exchange(&self.fluid, &node.state)?;
        Ok(node.balance(exchange.mass_kg_s, exchange.enthalpy_w, heat_w, wall_rate_k_s))
    }
}

/// The two node equations and their derivatives at a trial point.
struct Linearised<D> {
    residual: [D; 2],
    /// Rows: energy, volume; columns: V, T.
    jacobian: [[D; 2]; 2],
    state: State<D>,
    /// `du/drho` at constant temperature, J m³/kg².
    u_rho: D,
}

impl<D: Real> Linearised<D> {
    /// Solve the linearised equations for a right-hand side.
    fn solve(&self, f: [D; 2]) -> [D; 2] {
        let j = &self.jacobian;
        let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        [(f[0] * j[1][1] - f[1] * j[0][1]) / determinant, (f[1] * j[0][0] - f[0] * j[1][0]) / determinant]
    }
}
