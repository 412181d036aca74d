//! Coexistence of vapour and liquid, from the equation itself (Maxwell's construction).
//!
//! Below the critical temperature the isotherm has a vapour branch that ends at its first maximum (spinodal) and a
//! liquid branch that begins at its last minimum. Both are found by scanning from outside, so that the
//! unphysical loops of multiparameter equations in between do no harm. The saturation pressure is where the Gibbs
//! energies of the branches agree; their slopes in pressure are the volumes, so that Newton's method finds it, inside a
//! bracket. No ancillary equation is needed.
//!
//! Air is a mixture that its equation takes as one substance. In truth it condenses between two pressures, dew and bubble line, and the
//! equation's own line lies between them; what is between the two is refused.
use super::helmholtz::SATURATIONS;
use super::root::bracketed_newton;
use super::{Description, Fluid};
use crate::ThermalError;
use crate::real::powi;
use alloc::boxed::Box;

/// Vapour and liquid in equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saturation {
    /// Saturation pressure, Pa.
    pub pressure_pa: f64,
    /// Density of the vapour, kg/m³.
    pub vapour_kg_m3: f64,
    /// Density of the liquid, kg/m³.
    pub liquid_kg_m3: f64,
}

/// Relative distance below the critical temperature within which phases are not told apart.
pub(super) const CRITICAL_MARGIN: f64 = 0.005;
/// Temperature at which cylinders are filled, 15 °C, K.
const FILLING_TEMPERATURE_K: f64 = 288.15;
/// Steps of the scans for the spinodals.
const SCAN: usize = 400;

/// `ln(p/p_j) = (T_j/T) sum n theta^(k/2)`, `theta = 1 - T/T_j`: Lemmon et al. (2000), equation 1, table 10. Terms (n, k).
struct BoundaryLine(&'static [(f64, i32)]);

/// Maxcondentherm of air, K, Pa.
const AIR_J: (f64, f64) = (132.6312, 3.785_02e6);
const AIR_DEW: BoundaryLine =
    BoundaryLine(&[(-0.156_726_6, 1), (-5.539_635, 2), (0.756_721_2, 5), (-3.514_322, 8)]);
const AIR_BUBBLE: BoundaryLine = BoundaryLine(&[
    (0.226_072_4, 1),
    (-7.080_499, 2),
    (5.700_283, 3),
    (-12.440_17, 4),
    (17.819_26, 5),
    (-10.813_64, 6),
]);

impl BoundaryLine {
    fn pressure_pa(&self, temperature_k: f64) -> f64 {
        let root = libm::sqrt(1.0 - temperature_k / AIR_J.0);
        let sum: f64 = self.0.iter().map(|&(n, k)| n * powi(root, k)).sum();
        AIR_J.1 * libm::exp(AIR_J.0 / temperature_k * sum)
    }
}

impl Fluid {
    /// Refuse what lies between the dew and the bubble line of a mixture.
    pub(super) fn check_mixture(&self, pressure_pa: f64, temperature_k: f64) -> Result<(), ThermalError> {
        let is_mixture = self.name() == "air" && matches!(self.description, Description::Reference);
        if !is_mixture || temperature_k >= AIR_J.0 {
            return Ok(());
        }
        let dew_pa = AIR_DEW.pressure_pa(temperature_k);
        let bubble_pa = AIR_BUBBLE.pressure_pa(temperature_k);
        if pressure_pa <= dew_pa || pressure_pa >= bubble_pa {
            return Ok(());
        }
        let fluid = self.name();
        Err(ThermalError::BetweenDewAndBubble { fluid, pressure_pa, temperature_k, dew_pa, bubble_pa })
    }

    /// Vapour-liquid equilibrium at a temperature; `None` at or above the critical temperature and for the ideal gas.
    ///
    /// # Errors
    /// Below the domain, within 0.5 % below the critical temperature, or where the equation has no coexisting branches.
    pub fn saturation(&self, temperature_k: f64) -> Result<Option<Saturation>, ThermalError> {
        let critical_k = self.data().critical_temperature_k;
        if temperature_k >= critical_k || matches!(self.description, Description::IdealGas(_)) {
            return Ok(None);
        }
        self.check_temperature(temperature_k)?;
        let undecided = || ThermalError::NearCritical { fluid: self.name(), temperature_k, critical_k };
        if temperature_k > self.edge_k() {
            return Err(undecided());
        }
        let densest = self.domain().highest_density_kg_m3;
        let rt = self.specific_gas_constant_j_kg_k() * temperature_k;
        let isotherm = self.pressure_along_isotherm(temperature_k);
        let slope = |rho: f64| isotherm(rho).1;
        let vapour_end = first_sign_change(slope, densest * 1e-6, densest).ok_or_else(undecided)?;
        let liquid_end = first_sign_change(slope, densest, vapour_end).ok_or_else(undecided)?;
        let density = |p: f64, low: f64, high: f64, start: f64| {
            bracketed_newton(low, high, start, |rho| {
                let (pressure, slope) = isotherm(rho);
                (pressure - p, slope)
            })
            .unwrap_or(f64::NAN)
        };
        let gibbs = |rho: f64| {
            let state = self.state(rho, temperature_k);
            state.enthalpy_j_kg - temperature_k * state.entropy_j_kg_k
        };
        // From outside the curvature of each branch lets Newton's method approach without leaving it.
        let branches =
            |p: f64| (density(p, 0.0, vapour_end, p / rt), density(p, liquid_end, densest, densest));
        let (low, high) = (isotherm(liquid_end).0.max(0.0), isotherm(vapour_end).0);
        let pressure_pa = bracketed_newton(low, high, 0.5 * (low + high), |p| {
            let (vapour, liquid) = branches(p);
            (gibbs(vapour) - gibbs(liquid), 1.0 / vapour - 1.0 / liquid)
        })
        .ok_or_else(undecided)?;
        let (vapour_kg_m3, liquid_kg_m3) = branches(pressure_pa);
        Ok(Some(Saturation { pressure_pa, vapour_kg_m3, liquid_kg_m3 }))
    }

    /// Equilibrium at a temperature, within the margin below the critical one that at its edge. From there to the
    /// critical temperature gas that is thinner than the vapour or below the pressure at the edge is gas.
    pub(super) fn saturation_or_edge(&self, temperature_k: f64) -> Result<Option<Saturation>, ThermalError> {
        self.saturation(temperature_k.min(self.edge_k()))
    }

    /// Saturation at a temperature not above, from the few that are kept; `None` where there is none. Pressure and density
    /// of the vapour rise along the saturation line: what is below these is gas. A saturation of its own would cost
    /// thousands of evaluations.
    pub(super) fn saturation_not_above(&self, temperature_k: f64) -> Option<Saturation> {
        let Description::Reference = self.description else { return None };
        let (low, high) = (self.data().lowest_temperature_k, self.edge_k());
        let last = SATURATIONS - 1;
        let position = (temperature_k - low) / (high - low) * last as f64;
        if position.is_nan() || position < 0.0 {
            return None;
        }
        let index = (position as usize).min(last);
        let at_k = low + (high - low) * index as f64 / last as f64;
        let found = self.reference.saturation[index]
            .get_or_init(|| Box::new(self.saturation(at_k.min(high)).ok().flatten()));
        found.filter(|_| at_k <= temperature_k)
    }

    /// Highest temperature below the critical one at which phases are told apart, K.
    pub(super) fn edge_k(&self) -> f64 {
        self.data().critical_temperature_k * (1.0 - CRITICAL_MARGIN)
    }

    /// Whether it condenses under pressure at 15 °C: a liquid of it is a mistake in the fill, not a cryogenic state.
    pub(super) fn liquefies(&self) -> bool {
        self.edge_k() > FILLING_TEMPERATURE_K
    }

    /// The refusal of a condensed state of such a gas.
    pub(super) fn condensed(&self, temperature_k: f64, saturation_pa: f64) -> ThermalError {
        let at_15_degc_pa = match self.saturation(FILLING_TEMPERATURE_K) {
            Ok(Some(saturation)) => saturation.pressure_pa,
            _ => f64::NAN,
        };
        ThermalError::Condensed { fluid: self.name(), temperature_k, saturation_pa, at_15_degc_pa }
    }

    /// Refuse a two-phase state, and a liquid one of a gas that condenses at 15 °C.
    pub(super) fn check_phase(&self, density_kg_m3: f64, temperature_k: f64) -> Result<(), ThermalError> {
        let critical_k = self.data().critical_temperature_k;
        if temperature_k >= critical_k {
            return Ok(());
        }
        // Thin gas is far from condensing whatever the temperature above 0.95 of the critical one.
        let critical_density = self.data().reducing_density_mol_m3 * self.data().molar_mass_kg_mol;
        if temperature_k > 0.95 * critical_k && density_kg_m3 < 0.1 * critical_density {
            return Ok(());
        }
        let mixture = || self.check_mixture(self.pressure_pa(density_kg_m3, temperature_k), temperature_k);
        if self.saturation_not_above(temperature_k).is_some_and(|known| density_kg_m3 <= known.vapour_kg_m3) {
            return mixture();
        }
        let Some(saturation) = self.saturation_or_edge(temperature_k)? else { return Ok(()) };
        let liquid = density_kg_m3 >= saturation.liquid_kg_m3;
        if density_kg_m3 <= saturation.vapour_kg_m3 || liquid && !self.liquefies() {
            return mixture();
        }
        if temperature_k > self.edge_k() {
            return Err(ThermalError::NearCritical { fluid: self.name(), temperature_k, critical_k });
        }
        if self.liquefies() {
            return Err(self.condensed(temperature_k, saturation.pressure_pa));
        }
        Err(ThermalError::TwoPhase {
            fluid: self.name(),
            temperature_k,
            density_kg_m3,
            vapour_kg_m3: saturation.vapour_kg_m3,
            liquid_kg_m3: saturation.liquid_kg_m3,
        })
    }
}

/// First point on the way from `from` to `to` where `f` is no longer positive, on a geometric scan refined by bisection.
fn first_sign_change(f: impl Fn(f64) -> f64, from: f64, to: f64) -> Option<f64> {
    let ratio = libm::pow(to / from, 1.0 / SCAN as f64);
    let mut before = from;
    for _ in 0..SCAN {
        let after = before * ratio;
        if f(after) <= 0.0 {
            let (mut good, mut bad) = (before, after);
            for _ in 0..60 {
                let middle = 0.5 * (good + bad);
                if f(middle) > 0.0 { good = middle } else { bad = middle }
            }
            return Some(good);
        }
        before = after;
    }
    None
}
