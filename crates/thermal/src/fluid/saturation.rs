//! Coexistence of vapour and liquid, from the equation itself (Maxwell's construction).
//!
//! Below the critical temperature the isotherm has a vapour branch that ends at its first maximum (spinodal) and a
//! liquid branch that begins at its last minimum. Both are found by scanning from outside, so that the
//! unphysical loops of multiparameter equations in between do no harm. The saturation pressure is where the Gibbs
//! energies of the branches agree, by bisection: slow (about 1 ms) and safe. No ancillary equation is needed.
use super::{Description, Fluid};
use crate::ThermalError;

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
/// Steps of the scans for the spinodals.
const SCAN: usize = 400;
const BISECTIONS: usize = 80;

impl Fluid {
    /// Vapour-liquid equilibrium at a temperature; `None` at or above the critical temperature and for the ideal gas.
    ///
    /// # Errors
    /// Within 0.5 % below the critical temperature, or where the equation has no coexisting branches.
    pub fn saturation(&self, temperature_k: f64) -> Result<Option<Saturation>, ThermalError> {
        let critical_k = self.data.critical_temperature_k;
        if temperature_k >= critical_k || matches!(self.description, Description::IdealGas(_)) {
            return Ok(None);
        }
        let undecided = || ThermalError::NearCritical { fluid: self.name(), temperature_k, critical_k };
        if temperature_k > critical_k * (1.0 - CRITICAL_MARGIN) {
            return Err(undecided());
        }
        let densest = self.domain().highest_density_kg_m3;
        let slope = |rho: f64| {
            let (d, dd) = self.density_slopes(rho, temperature_k);
            1.0 + 2.0 * d + dd
        };
        let vapour_end = first_sign_change(slope, densest * 1e-6, densest).ok_or_else(undecided)?;
        let liquid_end = first_sign_change(slope, densest, vapour_end).ok_or_else(undecided)?;
        let pressure = |rho: f64| self.pressure_pa(rho, temperature_k);
        let gibbs = |rho: f64| {
            let state = self.state(rho, temperature_k);
            state.enthalpy_j_kg - temperature_k * state.entropy_j_kg_k
        };
        let mut low = pressure(liquid_end).max(0.0);
        let mut high = pressure(vapour_end);
        let (mut vapour, mut liquid) = (vapour_end, liquid_end);
        for _ in 0..BISECTIONS {
            let p = 0.5 * (low + high);
            vapour = branch_density(pressure, p, 0.0, vapour_end);
            liquid = branch_density(pressure, p, liquid_end, densest);
            if gibbs(vapour) < gibbs(liquid) { low = p } else { high = p }
        }
        Ok(Some(Saturation { pressure_pa: 0.5 * (low + high), vapour_kg_m3: vapour, liquid_kg_m3: liquid }))
    }

    /// Refuse a two-phase state.
    pub(super) fn check_phase(&self, density_kg_m3: f64, temperature_k: f64) -> Result<(), ThermalError> {
        let critical_k = self.data.critical_temperature_k;
        if temperature_k >= critical_k {
            return Ok(());
        }
        // Thin gas is far from condensing whatever the temperature above 0.95 of the critical one.
        let critical_density = self.data.reducing_density_mol_m3 * self.data.molar_mass_kg_mol;
        if temperature_k > 0.95 * critical_k && density_kg_m3 < 0.1 * critical_density {
            return Ok(());
        }
        let Some(saturation) = self.saturation(temperature_k)? else { return Ok(()) };
        if density_kg_m3 <= saturation.vapour_kg_m3 || density_kg_m3 >= saturation.liquid_kg_m3 {
            return Ok(());
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
    let ratio = (to / from).powf(1.0 / SCAN as f64);
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

/// Density on a branch where the pressure increases.
fn branch_density(pressure: impl Fn(f64) -> f64, p: f64, low: f64, high: f64) -> f64 {
    let (mut low, mut high) = (low, high);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if pressure(middle) < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
