//! The pressure that a tight cylinder has at a gas temperature.
use cylwatch_estimator::identify::published::Filling;
use cylwatch_estimator::thermal::fluid::Fluid;
use serde::{Deserialize, Serialize};

use crate::{DetectorError, error::positive};

/// How the pressure depends on the gas temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Law {
    /// Not at all: the filling's pressure is the limit of a switch.
    Constant,
    /// `p_fill T/T_fill`.
    IdealGas,
    /// `p_fill + 0.8457 bar/K (T - T_fill)`, as published.
    Published,
    /// Equation of state at the filling's density.
    RealGas {
        /// Name of the gas.
        gas: String,
    },
}

/// A law that passes through a filling.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Specification", into = "Specification")]
pub struct Expectation {
    law: Law,
    filling: Filling,
    /// The gas and its density, kg/m³, where the law is [`Law::RealGas`].
    gas: Option<(Fluid, f64)>,
}

/// What a saved state keeps.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Specification {
    law: Law,
    filling_pressure_pa: f64,
    filling_temperature_k: f64,
}

impl Expectation {
    /// The law through the filling.
    ///
    /// # Errors
    /// Pressure or temperature are not positive, the gas is not known, or the filling is outside its equation of state.
    pub fn try_new(law: Law, filling: Filling) -> Result<Self, DetectorError> {
        positive("pressure_pa", filling.pressure_pa)?;
        positive("temperature_k", filling.temperature_k)?;
        let gas = match &law {
            Law::RealGas { gas } => {
                let fluid = Fluid::named(gas)?;
                let Filling { pressure_pa, temperature_k } = filling;
                let density_kg_m3 = fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?;
                Some((fluid, density_kg_m3))
            }
            _ => None,
        };
        Ok(Self { law, filling, gas })
    }

    /// Expected pressure, Pa, at a gas temperature, K; `None` outside the equation of state, and without a temperature where the law
    /// needs one.
    pub fn pressure_pa(&self, gas_k: Option<f64>) -> Option<f64> {
        let Filling { pressure_pa, temperature_k } = self.filling;
        if self.law == Law::Constant {
            return Some(pressure_pa);
        }
        let gas_k = gas_k?;
        match (&self.law, &self.gas) {
            (Law::IdealGas, _) => Some(pressure_pa * gas_k / temperature_k),
            (Law::RealGas { .. }, Some((fluid, density_kg_m3))) => {
                fluid.check(*density_kg_m3, gas_k).ok()?;
                Some(fluid.pressure_pa(*density_kg_m3, gas_k))
            }
            _ => Some(self.filling.published_pressure_pa(gas_k)),
        }
    }
}

impl PartialEq for Expectation {
    fn eq(&self, other: &Self) -> bool {
        self.law == other.law && self.filling == other.filling
    }
}

impl TryFrom<Specification> for Expectation {
    type Error = DetectorError;

    fn try_from(specification: Specification) -> Result<Self, DetectorError> {
        let pressure_pa = specification.filling_pressure_pa;
        let temperature_k = specification.filling_temperature_k;
        Self::try_new(specification.law, Filling { pressure_pa, temperature_k })
    }
}

impl From<Expectation> for Specification {
    fn from(expectation: Expectation) -> Self {
        Self {
            law: expectation.law,
            filling_pressure_pa: expectation.filling.pressure_pa,
            filling_temperature_k: expectation.filling.temperature_k,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const FULL: Filling = Filling { pressure_pa: 200e5, temperature_k: 288.15 };

    fn at_minus_25(law: Law) -> f64 {
        Expectation::try_new(law, FULL).unwrap().pressure_pa(Some(248.15)).unwrap()
    }

    #[test]
    fn the_ideal_gas_misses_a_cold_cylinder_by_12_bar() {
        // CoolProp 8.0 (HEOS nitrogen): 160.09 bar; p/T by hand: 172.24 bar; published slope by hand: 166.17 bar.
        let real_pa = at_minus_25(Law::RealGas { gas: "nitrogen".into() });
        assert!((real_pa - 160.09e5).abs() < 0.006e5, "{real_pa} Pa");
        assert_relative_eq!(at_minus_25(Law::IdealGas), 172.236e5, max_relative = 1e-5);
        assert_relative_eq!(at_minus_25(Law::Published), 166.172e5, max_relative = 1e-9);
        assert_eq!(at_minus_25(Law::Constant), 200e5);
    }

    #[test]
    fn states_outside_the_equation_of_state_expect_nothing() {
        let real = Expectation::try_new(Law::RealGas { gas: "nitrogen".into() }, FULL).unwrap();
        assert_eq!([Some(-1.0), Some(1e6), None].map(|gas_k| real.pressure_pa(gas_k)), [None; 3]);
    }

    #[test]
    fn fillings_that_cannot_be_are_refused() {
        let refused = |law, filling| Expectation::try_new(law, filling).is_err();
        assert!(refused(Law::Published, Filling { pressure_pa: -1.0, ..FULL }));
        assert!(refused(Law::IdealGas, Filling { temperature_k: f64::NAN, ..FULL }));
        assert!(refused(Law::RealGas { gas: "xenon".into() }, FULL));
        assert!(refused(Law::RealGas { gas: "nitrogen".into() }, Filling { pressure_pa: 1e20, ..FULL }));
    }
}
