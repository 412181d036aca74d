//! Equations of state and transport properties of gases.
//!
//! A [`Fluid`] is a gas with the equation that describes it: the fluid's reference equation (`helmholtz`), the
//! ideal gas, or Peng-Robinson (`peng_robinson`), all behind `helmholtz::HelmholtzEnergy` and all with
//! the ideal part (heat capacity) of the reference equation. Every property of a [`State`] follows from one Helmholtz
//! energy, so no two of them can disagree. Numbers are generic over [`Real`]: with dual numbers every property comes with exact derivatives.
//!
//! # Validity
//! [`Fluid::domain`]. Evaluation without check ([`Fluid::state`]) is smooth everywhere, metastable states included;
//! the checked functions refuse what is outside the domain or two-phase. Near the critical point (within 0.5 %
//! of the critical temperature below it) phases are not told apart, and states in question are refused.
mod data;
mod derivatives;
mod helmholtz;
mod ideal_gas;
mod peng_robinson;
mod root;
mod saturation;
mod solve;
mod special;
mod state;
#[cfg(test)]
mod tests;
mod transport;

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
pub use saturation::Saturation;
use serde::{Deserialize, Serialize};
pub use state::State;

use crate::ThermalError;
pub use crate::real::Real;
use data::terms::FluidData;
use derivatives::Reduced;
use helmholtz::{HelmholtzEnergy, Multiparameter, ideal};
use ideal_gas::IdealGas;
use peng_robinson::PengRobinson;
use transport::TransportState;

/// Which equation describes the fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Equation {
    /// The fluid's multiparameter reference equation.
    #[default]
    Reference,
    /// `p = rho R T`.
    IdealGas,
    /// The cubic equation of Peng and Robinson.
    PengRobinson,
}

/// The equation with what it needs.
#[derive(Clone, Copy, Debug)]
enum Description {
    Reference,
    IdealGas(IdealGas),
    PengRobinson(PengRobinson),
}

/// A gas with its equation of state. Cheap to clone.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(into = "Named", try_from = "Named")]
pub struct Fluid {
    reference: Arc<Multiparameter>,
    description: Description,
}

/// What names a fluid.
#[derive(Serialize, Deserialize)]
struct Named {
    name: String,
    equation: Equation,
}

impl From<Fluid> for Named {
    fn from(fluid: Fluid) -> Self {
        Self { name: fluid.name().to_owned(), equation: fluid.equation() }
    }
}

impl TryFrom<Named> for Fluid {
    type Error = ThermalError;

    fn try_from(named: Named) -> Result<Self, ThermalError> {
        Ok(Self::named(&named.name)?.with_equation(named.equation))
    }
}

/// Where a fluid's equation may be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Lowest temperature, K.
    pub lowest_temperature_k: f64,
    /// Highest temperature, K.
    pub highest_temperature_k: f64,
    /// Highest pressure, Pa.
    pub highest_pressure_pa: f64,
    /// Highest density, kg/m³.
    pub highest_density_kg_m3: f64,
    /// Critical temperature, K; above it there is one phase.
    pub critical_temperature_k: f64,
}

/// Pressure with its two derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureDerivatives {
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// `(dp/dT)_rho`, Pa/K.
    pub dp_dt_pa_k: f64,
    /// `(dp/drho)_T`, Pa m³/kg.
    pub dp_drho_pa_m3_kg: f64,
}

/// Densest state considered, relative to the liquid at the triple point.
const DENSEST: f64 = 1.35;
/// Densest state of a cubic equation, relative to its covolume limit.
const DENSEST_CUBIC: f64 = 0.98;

/// Pressures, Pa, and densities, kg/m³, below this lose their digits in products; they count as not positive.
const UNDERFLOW_LIMIT: f64 = 1e-200;

impl Fluid {
    /// A fluid with its reference equation.
    ///
    /// # Errors
    /// The name is not known; the message lists those that are.
    pub fn named(name: &str) -> Result<Self, ThermalError> {
        let wanted = name.to_ascii_lowercase();
        let Some(fluid) = data::ALL.iter().find(|fluid| fluid.name() == wanted) else {
            let meant = data::ALL.iter().find(|fluid| fluid.also().contains(&wanted.as_str()));
            #[cfg(feature = "files")]
            let nearest = crate::document::suggestion(&wanted, Self::names());
            #[cfg(not(feature = "files"))]
            let nearest = String::new();
            let nearest = meant.map_or(nearest, |fluid| format!(", did you mean {}?", fluid.name()));
            return Err(ThermalError::UnknownFluid {
                name: name.to_owned(),
                nearest,
                known: Self::names().collect::<Vec<_>>().join(", "),
            });
        };
        Ok(Self::of(fluid.data()))
    }

    fn of(data: FluidData) -> Self {
        Self { reference: Arc::new(Multiparameter::new(data)), description: Description::Reference }
    }

    fn data(&self) -> &FluidData {
        &self.reference.data
    }

    /// Names that [`Fluid::named`] knows.
    pub fn names() -> impl ExactSizeIterator<Item = &'static str> {
        data::ALL.iter().map(data::Entry::name)
    }

    /// The same gas with another equation.
    #[must_use]
    pub fn with_equation(self, equation: Equation) -> Self {
        let description = match equation {
            Equation::Reference => Description::Reference,
            Equation::IdealGas => Description::IdealGas(IdealGas),
            Equation::PengRobinson => Description::PengRobinson(PengRobinson::new(self.data())),
        };
        Self { description, ..self }
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.data().name
    }

    /// The equation in use.
    pub fn equation(&self) -> Equation {
        match self.description {
            Description::Reference => Equation::Reference,
            Description::IdealGas(_) => Equation::IdealGas,
            Description::PengRobinson(_) => Equation::PengRobinson,
        }
    }

    /// Source of the reference equation.
    pub fn reference(&self) -> &'static str {
        self.data().reference
    }

    /// Specific gas constant of the equation, J/(kg K).
    pub fn specific_gas_constant_j_kg_k(&self) -> f64 {
        self.data().gas_constant_j_mol_k / self.data().molar_mass_kg_mol
    }

    /// Where the equation may be used.
    pub fn domain(&self) -> Domain {
        let liquid = self.data().triple_liquid_density_mol_m3 * self.data().molar_mass_kg_mol * DENSEST;
        let highest_density_kg_m3 = match self.description {
            // Its liquids differ from the measured ones: that of helium is denser.
            Description::PengRobinson(cubic) => DENSEST_CUBIC * cubic.densest_kg_m3(),
            _ => liquid,
        };
        Domain {
            lowest_temperature_k: self.data().lowest_temperature_k,
            highest_temperature_k: self.data().highest_temperature_k,
            highest_pressure_pa: self.data().highest_pressure_pa,
            highest_density_kg_m3,
            critical_temperature_k: self.data().critical_temperature_k,
        }
    }

    fn residual<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> Reduced<D> {
        match &self.description {
            Description::Reference => self.reference.residual(density_kg_m3, temperature_k),
            Description::IdealGas(equation) => equation.residual(density_kg_m3, temperature_k),
            Description::PengRobinson(equation) => equation.residual(density_kg_m3, temperature_k),
        }
    }

    /// All properties at a density, kg/m³, and temperature, K. No check: smooth, metastable states included.
    pub fn state<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> State<D> {
        let ideal = ideal(self.data(), density_kg_m3, temperature_k);
        let residual = self.residual(density_kg_m3, temperature_k);
        let r = self.specific_gas_constant_j_kg_k();
        State::from_reduced(r, density_kg_m3, temperature_k, &ideal, &residual)
    }

    /// All properties, after [`Fluid::check`].
    ///
    /// # Errors
    /// As [`Fluid::check`].
    pub fn checked_state(&self, density_kg_m3: f64, temperature_k: f64) -> Result<State, ThermalError> {
        self.check(density_kg_m3, temperature_k)?;
        Ok(self.state(density_kg_m3, temperature_k))
    }

    /// Pressure, Pa, without check.
    pub fn pressure_pa(&self, density_kg_m3: f64, temperature_k: f64) -> f64 {
        let (slope, _) = self.density_slopes(density_kg_m3, temperature_k);
        density_kg_m3 * self.specific_gas_constant_j_kg_k() * temperature_k * (1.0 + slope)
    }

    #[inline(always)]
    fn density_slopes(&self, density_kg_m3: f64, temperature_k: f64) -> (f64, f64) {
        match &self.description {
            Description::Reference => self.reference.residual_density_slopes(density_kg_m3, temperature_k),
            Description::IdealGas(_) => (0.0, 0.0),
            Description::PengRobinson(equation) => {
                equation.residual_density_slopes(density_kg_m3, temperature_k)
            }
        }
    }

    /// Pressure and both its derivatives, without check.
    pub fn pressure_with_derivatives(&self, density_kg_m3: f64, temperature_k: f64) -> PressureDerivatives {
        let residual = self.residual(density_kg_m3, temperature_k);
        let r = self.specific_gas_constant_j_kg_k();
        PressureDerivatives {
            pressure_pa: density_kg_m3 * r * temperature_k * (1.0 + residual.d),
            dp_dt_pa_k: density_kg_m3 * r * (1.0 + residual.d - residual.dt),
            dp_drho_pa_m3_kg: r * temperature_k * (1.0 + 2.0 * residual.d + residual.dd),
        }
    }

    /// Whether a state is inside the domain and single-phase.
    ///
    /// # Errors
    /// Names the value that is outside, the bound, and what to do.
    pub fn check(&self, density_kg_m3: f64, temperature_k: f64) -> Result<(), ThermalError> {
        self.check_temperature(temperature_k)?;
        self.check_density(density_kg_m3)?;
        // Between the phases the pressure may be anything, even negative: the phase comes first.
        self.check_phase(density_kg_m3, temperature_k)?;
        self.check_pressure(self.pressure_pa(density_kg_m3, temperature_k), temperature_k)
    }

    fn check_temperature(&self, temperature_k: f64) -> Result<(), ThermalError> {
        let domain = self.domain();
        if temperature_k >= domain.lowest_temperature_k && temperature_k <= domain.highest_temperature_k {
            return Ok(());
        }
        Err(ThermalError::TemperatureOutside {
            fluid: self.name(),
            temperature_k,
            lowest_k: domain.lowest_temperature_k,
            highest_k: domain.highest_temperature_k,
        })
    }

    fn check_density(&self, density_kg_m3: f64) -> Result<(), ThermalError> {
        let highest_kg_m3 = self.domain().highest_density_kg_m3;
        if density_kg_m3 > UNDERFLOW_LIMIT && density_kg_m3 <= highest_kg_m3 {
            return Ok(());
        }
        Err(ThermalError::DensityOutside { fluid: self.name(), density_kg_m3, highest_kg_m3 })
    }

    /// Pressure inside the range and below the melting line; the ideal gas does not freeze.
    fn check_pressure(&self, pressure_pa: f64, temperature_k: f64) -> Result<(), ThermalError> {
        let highest_pa = self.domain().highest_pressure_pa;
        if !(pressure_pa > UNDERFLOW_LIMIT && pressure_pa <= highest_pa) {
            return Err(ThermalError::PressureOutside { fluid: self.name(), pressure_pa, highest_pa });
        }
        let melting_pa = self.data().melting.pressure_pa(temperature_k);
        if pressure_pa > melting_pa && !matches!(self.description, Description::IdealGas(_)) {
            return Err(ThermalError::Solid { fluid: self.name(), pressure_pa, temperature_k, melting_pa });
        }
        Ok(())
    }

    /// Viscosity, Pa s.
    pub fn viscosity_pa_s<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> D {
        self.data().transport.viscosity_pa_s(density_kg_m3, temperature_k)
    }

    /// Thermal conductivity, W/(m K), with its enhancement near the critical point.
    pub fn conductivity_w_m_k<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> D {
        let background = self.data().transport.background_conductivity_w_m_k(density_kg_m3, temperature_k);
        let reference_k = self.data().transport.reference_temperature_k();
        if reference_k.is_some_and(|reference_k| temperature_k.re() >= reference_k) {
            return background;
        }
        let state = self.state(density_kg_m3, temperature_k);
        let dp_drho_reference = reference_k.map_or(D::from(0.0), |reference_k| {
            let reference = self.residual(density_kg_m3, D::from(reference_k));
            (reference.d * 2.0 + reference.dd + 1.0) * (self.specific_gas_constant_j_kg_k() * reference_k)
        });
        let at = TransportState {
            temperature_k,
            density_kg_m3,
            dp_drho_pa_m3_kg: state.dp_drho_pa_m3_kg,
            cp_j_kg_k: state.cp_j_kg_k,
            cv_j_kg_k: state.cv_j_kg_k,
        };
        let viscosity = self.viscosity_pa_s(density_kg_m3, temperature_k);
        background + self.data().transport.critical_enhancement_w_m_k(&at, viscosity, dp_drho_reference)
    }
}
