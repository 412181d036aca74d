//! Section 2 of the paper: how much gas there is, and how much heat it holds beside the steel.
//!
//! The paper expands 20 L of 200 bar as an ideal gas to 4000 L of 1.15 kg/m³ and takes 1000 J/(kg K) for the gas. At constant volume it
//! is `c_v` that counts, and the real gas is denser or thinner than the ideal one by its compressibility factor.
use super::ReproduceError;
use super::cylinder::{FILL_PRESSURE_PA, FILL_TEMPERATURE_K, VOLUME_M3};
use crate::thermal::fluid::Fluid;

/// The paper's figures: empty mass of the steel cylinder, kg.
pub(crate) const STEEL_KG: f64 = 22.4;
/// Its heat capacity, J/(kg K).
pub(crate) const STEEL_J_KG_K: f64 = 460.0;
/// Volume that the gas expands to at 1 bar, m³.
const EXPANDED_M3: f64 = 4.0;
/// Density at 20 °C and 1 bar, kg/m³.
const EXPANDED_KG_M3: f64 = 1.15;
/// Heat capacity of the gas, J/(kg K).
const GAS_J_KG_K: f64 = 1000.0;

/// The arithmetic of the paper beside the real gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Section2 {
    /// Gas mass, kg, by the paper.
    pub paper_kg: f64,
    /// Gas mass, kg, by the equation of state.
    pub real_kg: f64,
    /// Its compressibility factor.
    pub compressibility: f64,
    /// Heat capacity of the steel, J/K.
    pub steel_j_k: f64,
    /// Heat capacity of the gas, J/K, by the paper.
    pub paper_j_k: f64,
    /// At constant volume by the equation of state, J/K.
    pub real_j_k: f64,
    /// The equation's `c_v`, J/(kg K).
    pub real_cv_j_kg_k: f64,
}

impl Section2 {
    /// Evaluates both.
    ///
    /// # Errors
    /// The gas's; none for nitrogen in this state.
    pub(crate) fn evaluated() -> Result<Self, ReproduceError> {
        let gas = Fluid::named("nitrogen")?;
        let rho = gas.density_from_pressure_temperature(FILL_PRESSURE_PA, FILL_TEMPERATURE_K)?;
        let state = gas.checked_state(rho, FILL_TEMPERATURE_K)?;
        let (paper_kg, real_kg) = (EXPANDED_M3 * EXPANDED_KG_M3, rho * VOLUME_M3);
        Ok(Self {
            paper_kg,
            real_kg,
            compressibility: state.compressibility,
            steel_j_k: STEEL_KG * STEEL_J_KG_K,
            paper_j_k: paper_kg * GAS_J_KG_K,
            real_j_k: real_kg * state.cv_j_kg_k,
            real_cv_j_kg_k: state.cv_j_kg_k,
        })
    }

    /// Steel over gas by the paper, heat capacities.
    pub(crate) fn paper_ratio(&self) -> f64 {
        self.steel_j_k / self.paper_j_k
    }

    /// Steel over gas, heat capacities at constant volume.
    pub(crate) fn real_ratio(&self) -> f64 {
        self.steel_j_k / self.real_j_k
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_gas_is_a_quarter_of_the_heat_and_not_a_third() {
        // CoolProp 8.0: 4.4637 kg, Z 1.0478, cv 784 J/(kg K).
        let found = Section2::evaluated().unwrap();
        assert_abs_diff_eq!(found.real_kg, 4.4637, epsilon = 5e-5);
        assert_abs_diff_eq!(found.compressibility, 1.0478, epsilon = 5e-5);
        assert_abs_diff_eq!(found.real_cv_j_kg_k, 784.0, epsilon = 0.5);
        assert_abs_diff_eq!(found.paper_kg, 4.6, epsilon = 1e-12);
        assert_abs_diff_eq!(found.paper_ratio(), 2.24, epsilon = 5e-3);
        assert_abs_diff_eq!(found.real_ratio(), 2.94, epsilon = 5e-3);
    }
}
