//! The gas of the reduced model: one well-mixed node in the chart (temperature, mass, mean wall temperature).
//!
//! With `V = V_0 [1 + a (T_w - T_0) + b (p - p_0)]`, `D = 1 + V_0 b p_rho rho / V` and
//! `dV = alpha dT_w + beta dT + gamma dm`, `alpha = V_0 a / D`, `beta = V_0 b p_T / D`, `gamma = V_0 b p_rho / (V D)`, the
//! energy balance of [`crate::model::well_mixed`] reads
//!
//! `(m c_v + T p_T beta) dT/dt = Q - T p_T [alpha dT_w/dt + r (1/rho - gamma)]`, `dm/dt = -r`.
//!
//! Properties with their derivatives come from the [`Chart`].
use super::Pressure;
use super::chart::{Chart, Properties, Property};
use crate::ThermalError;
use crate::fluid::{Fluid, Real};
use crate::vessel::InnerVolume;

/// A value with its derivatives by gas temperature, gas mass and mean wall temperature.
pub(super) type Dual = crate::real::Dual<3>;

/// Relative change of the volume below which it counts as found.
const VOLUME_TOLERANCE: f64 = 1e-13;
const MAX_ITERATIONS: usize = 30;

/// A value at an instant with its derivatives `[by gas temperature, by mass, by mean wall temperature]`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slope {
    pub value: f64,
    pub by: [f64; 3],
}

impl From<f64> for Slope {
    fn from(value: f64) -> Self {
        Self { value, by: [0.0; 3] }
    }
}

impl From<Dual> for Slope {
    fn from(dual: Dual) -> Self {
        Self { value: dual.re, by: dual.eps }
    }
}

/// The gas at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct GasState<D> {
    /// Pressure, Pa.
    pub pressure_pa: D,
    /// Heat that raises the gas by one kelvin, J/K: `m c_v + T p_T beta`.
    pub capacity_j_k: D,
    /// Heat taken per kelvin of the mean wall temperature, J/K: `T p_T alpha`.
    pub per_wall_j_k: D,
    /// Heat taken per kilogram that leaves, J/kg: `T p_T (1/rho - gamma)`.
    pub per_outflow_j_kg: D,
}

impl<D: Into<Slope>> GasState<D> {
    fn into_slopes(self) -> GasState<Slope> {
        GasState {
            pressure_pa: self.pressure_pa.into(),
            capacity_j_k: self.capacity_j_k.into(),
            per_wall_j_k: self.per_wall_j_k.into(),
            per_outflow_j_kg: self.per_outflow_j_kg.into(),
        }
    }
}

/// The gas node of a vessel.
#[derive(Clone, Debug)]
pub(super) struct GasNode {
    chart: Chart,
    volume: InnerVolume,
    /// Last volume, m³: where Newton starts.
    guess_m3: f64,
    /// The same for settled gas.
    settled_guess_m3: f64,
}

impl GasNode {
    pub(super) fn new(fluid: Fluid, volume: InnerVolume) -> Self {
        Self {
            chart: Chart::new(fluid),
            volume,
            guess_m3: volume.volume_m3,
            settled_guess_m3: volume.volume_m3,
        }
    }

    pub(super) fn fluid(&self) -> &Fluid {
        self.chart.fluid()
    }

    pub(super) fn reference_volume_m3(&self) -> f64 {
        self.volume.volume_m3
    }

    /// Where Newton starts: for the gas, and for settled gas.
    pub(super) fn guesses_m3(&self) -> [f64; 2] {
        [self.guess_m3, self.settled_guess_m3]
    }

    pub(super) fn set_guesses_m3(&mut self, guesses_m3: [f64; 2]) {
        [self.guess_m3, self.settled_guess_m3] = guesses_m3;
    }

    /// Volume at a gas temperature, mass and mean wall temperature, m³.
    ///
    /// # Errors
    /// The mass is not positive or a value not finite.
    pub(super) fn volume_m3(
        &mut self,
        temperature_k: f64,
        mass_kg: f64,
        wall_k: f64,
    ) -> Result<f64, ThermalError> {
        let InnerVolume { volume_m3: v0, pressure_expansion_per_pa: b, .. } = self.volume;
        let sane = mass_kg > 0.0 && temperature_k > 0.0 && mass_kg.is_finite() && wall_k.is_finite();
        let mut v = self.guess_m3;
        if sane && temperature_k.is_finite() {
            let mut isotherm = self.chart.isotherm(mass_kg / v, temperature_k);
            for _ in 0..MAX_ITERATIONS {
                let rho = mass_kg / v;
                if isotherm.is_some_and(|isotherm| !isotherm.holds(rho)) {
                    isotherm = self.chart.isotherm(rho, temperature_k);
                }
                let (pressure_pa, slope) = match &isotherm {
                    Some(isotherm) => isotherm.pressure(rho),
                    None => {
                        let p = self.chart.fluid().pressure_with_derivatives(rho, temperature_k);
                        (p.pressure_pa, p.dp_drho_pa_m3_kg)
                    }
                };
                let elastic = v0 * b * slope * rho / v;
                let step = (v - self.volume.volume_m3(wall_k, pressure_pa)) / (1.0 + elastic);
                v -= step.clamp(-0.3 * v, 0.3 * v);
                // The next Newton step would be some `elastic (step / v)^2`, a few times more in dense gas.
                if 10.0 * elastic * step * step <= VOLUME_TOLERANCE * v * v {
                    self.guess_m3 = v;
                    return Ok(v);
                }
                if !v.is_finite() {
                    break;
                }
            }
        }
        Err(ThermalError::NoGasState { mass_kg, energy_j: f64::NAN })
    }

    /// The gas at a temperature, mass and mean wall temperature; derivatives are zero unless asked for.
    ///
    /// # Errors
    /// As [`GasNode::volume_m3`].
    pub(super) fn at(
        &mut self,
        t: f64,
        m: f64,
        wall_k: f64,
        derivatives: bool,
    ) -> Result<GasState<Slope>, ThermalError> {
        let v = self.volume_m3(t, m, wall_k)?;
        let rho = m / v;
        let Properties { p, cv, p_t, p_rho } = self.chart.properties(rho, t);
        let properties = [p, cv, p_t, p_rho];
        if !derivatives {
            return Ok(self.combine(t, m, v, rho, properties.map(|property| property.value)).into_slopes());
        }
        let volume_by = self.volume_by(rho, v, p_t.value, p_rho.value);
        let rho_by = [-rho * volume_by[0] / v, (1.0 - rho * volume_by[1]) / v, -rho * volume_by[2] / v];
        let dual = |value: f64, by: [f64; 3]| Dual { re: value, eps: by };
        let lift = |Property { value, by_t, by_rho }: Property| {
            dual(value, [by_t + by_rho * rho_by[0], by_rho * rho_by[1], by_rho * rho_by[2]])
        };
        let properties = properties.map(lift);
        let (t, m) = (dual(t, [1.0, 0.0, 0.0]), dual(m, [0.0, 1.0, 0.0]));
        Ok(self.combine(t, m, dual(v, volume_by), dual(rho, rho_by), properties).into_slopes())
    }

    /// Pressure alone, Pa.
    ///
    /// # Errors
    /// As [`GasNode::volume_m3`].
    pub(super) fn pressure_pa(&mut self, t: f64, m: f64, wall_k: f64) -> Result<f64, ThermalError> {
        let rho = m / self.volume_m3(t, m, wall_k)?;
        Ok(self.chart.pressure_pa(rho, t))
    }

    /// Pressure, Pa, of gas that has settled with the wall at one temperature.
    ///
    /// # Errors
    /// As [`GasNode::volume_m3`].
    pub(super) fn settled_pressure_pa(&mut self, t: f64, m: f64) -> Result<f64, ThermalError> {
        let guess_m3 = core::mem::replace(&mut self.guess_m3, self.settled_guess_m3);
        let pressure_pa = self.pressure_pa(t, m, t);
        self.settled_guess_m3 = core::mem::replace(&mut self.guess_m3, guess_m3);
        pressure_pa
    }

    /// Pressure with its derivatives.
    ///
    /// # Errors
    /// As [`GasNode::volume_m3`].
    pub(super) fn pressure(&mut self, t: f64, m: f64, wall_k: f64) -> Result<Pressure, ThermalError> {
        let v = self.volume_m3(t, m, wall_k)?;
        let rho = m / v;
        let Property { value, by_t, by_rho } = self.chart.pressure(rho, t);
        let by = self.volume_by(rho, v, by_t, by_rho);
        Ok(Pressure {
            pressure_pa: value,
            per_gas_k: by_t - by_rho * rho * by[0] / v,
            per_mass_kg: by_rho * (1.0 - rho * by[1]) / v,
            per_wall_k: -by_rho * rho * by[2] / v,
        })
    }

    /// Derivatives `[beta, gamma, alpha]` of the volume.
    fn volume_by(&self, rho: f64, v: f64, p_t: f64, p_rho: f64) -> [f64; 3] {
        let InnerVolume { volume_m3: v0, thermal_expansion_per_k: a, pressure_expansion_per_pa: b, .. } =
            self.volume;
        let d = 1.0 + v0 * b * p_rho * rho / v;
        [v0 * b * p_t / d, v0 * b * p_rho / (v * d), v0 * a / d]
    }

    /// Properties: `[p, c_v, p_T, p_rho]`.
    fn combine<D: Real>(&self, t: D, m: D, v: D, rho: D, [p, cv, p_t, p_rho]: [D; 4]) -> GasState<D> {
        let InnerVolume { volume_m3: v0, thermal_expansion_per_k: a, pressure_expansion_per_pa: b, .. } =
            self.volume;
        let elastic = (p_rho * rho / v * (v0 * b) + 1.0).recip();
        let work = t * p_t;
        GasState {
            pressure_pa: p,
            capacity_j_k: m * cv + work * p_t * elastic * (v0 * b),
            per_wall_j_k: work * elastic * (v0 * a),
            per_outflow_j_kg: work * (rho.recip() - p_rho * elastic / v * (v0 * b)),
        }
    }
}
