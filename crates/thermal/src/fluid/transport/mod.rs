//! Viscosity and thermal conductivity of the fluids, as functions of density and temperature.
//!
//! `eta = eta_0(T) + eta_r(rho, T)` and `lambda = lambda_0(T) + lambda_r(rho, T) + lambda_c`, where the
//! critical enhancement `lambda_c` alone needs derivatives of the equation of state. It is zero above the
//! reference temperature (about twice the critical one), so most states of a cylinder never pay for it.
//!
//! | fluid | viscosity | conductivity |
//! |---|---|---|
//! | nitrogen, argon, air | Lemmon and Jacobsen 2004 | the same |
//! | hydrogen (normal) | Muzny, Huber and Kazakov 2013 | Assael et al. 2011 |
//! | carbon dioxide | Laesecke and Muzny 2017 | Huber et al. 2016 |
//! | helium | Arp, McCarty and Friend 1998 | Hands and Arp 1981 |
//! | mixtures | Wilke 1950 | Mason and Saxena 1958 |
//!
//! All functions are generic over [`Real`], so dual numbers give exact derivatives. Values agree with
//! CoolProp 8.0.0; each module names its range of validity and the deviations.
mod carbon_dioxide;
mod critical;
mod helium;
mod hydrogen;
mod lemmon_jacobsen;
mod mixture;
#[cfg(test)]
mod tests;

pub(crate) use critical::OlchowySengers;
pub(crate) use lemmon_jacobsen::{LemmonJacobsenData, Term};
pub(crate) use mixture::{MixtureComponent, MixtureTransport};

use crate::fluid::Real;
use alloc::sync::Arc;

/// What the critical enhancement needs of the equation of state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TransportState<D> {
    /// Temperature, K.
    pub temperature_k: D,
    /// Density, kg/m³.
    pub density_kg_m3: D,
    /// `(dp/drho)_T`, Pa m³/kg.
    pub dp_drho_pa_m3_kg: D,
    /// Isobaric heat capacity, J/(kg K).
    pub cp_j_kg_k: D,
    /// Isochoric heat capacity, J/(kg K).
    pub cv_j_kg_k: D,
}

/// Transport correlations of one fluid.
#[derive(Clone, Debug)]
pub(super) enum Transport {
    /// The form of Lemmon and Jacobsen 2004.
    LemmonJacobsen(&'static LemmonJacobsenData),
    /// Normal hydrogen: Muzny et al. 2013, Assael et al. 2011.
    Hydrogen,
    /// Carbon dioxide: Laesecke and Muzny 2017, Huber et al. 2016.
    CarbonDioxide,
    /// Helium-4: Arp et al. 1998, Hands and Arp 1981.
    Helium,
    /// From the components: Wilke 1950, Mason and Saxena 1958.
    Mixture(Arc<MixtureTransport>),
}

impl Transport {
    /// Viscosity, Pa s. The critical enhancement of the viscosity, below 1 % except within 1 % of the
    /// critical temperature, is left out, as in the sources.
    #[inline]
    pub(crate) fn viscosity_pa_s<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> D {
        match self {
            Transport::LemmonJacobsen(data) => data.viscosity_pa_s(density_kg_m3, temperature_k),
            Transport::Hydrogen => hydrogen::viscosity_pa_s(density_kg_m3, temperature_k),
            Transport::CarbonDioxide => carbon_dioxide::viscosity_pa_s(density_kg_m3, temperature_k),
            Transport::Helium => helium::viscosity_pa_s(density_kg_m3, temperature_k),
            Transport::Mixture(data) => data.viscosity_pa_s(density_kg_m3, temperature_k),
        }
    }

    /// Thermal conductivity without the critical enhancement, W/(m K).
    #[inline]
    pub(crate) fn background_conductivity_w_m_k<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> D {
        match self {
            Transport::LemmonJacobsen(data) => data.conductivity_w_m_k(density_kg_m3, temperature_k),
            Transport::Hydrogen => hydrogen::conductivity_w_m_k(density_kg_m3, temperature_k),
            Transport::CarbonDioxide => carbon_dioxide::conductivity_w_m_k(density_kg_m3, temperature_k),
            Transport::Helium => helium::conductivity_w_m_k(density_kg_m3, temperature_k),
            Transport::Mixture(data) => data.conductivity_w_m_k(density_kg_m3, temperature_k),
        }
    }

    /// Critical enhancement of the thermal conductivity, W/(m K), zero far from the critical point.
    ///
    /// `viscosity` is that of the state, Pa s; `dp_drho_reference` is `(dp/drho)_T`, Pa m³/kg, at the same
    /// density and [`Self::reference_temperature_k`], ignored where that is `None`.
    pub(crate) fn critical_enhancement_w_m_k<D: Real>(
        &self,
        state: &TransportState<D>,
        viscosity: D,
        dp_drho_reference: D,
    ) -> D {
        match self {
            Transport::LemmonJacobsen(data) => {
                data.critical.conductivity_w_m_k(state, viscosity, dp_drho_reference)
            }
            Transport::Hydrogen => hydrogen::CRITICAL.conductivity_w_m_k(state, viscosity, dp_drho_reference),
            Transport::CarbonDioxide => {
                carbon_dioxide::CRITICAL.conductivity_w_m_k(state, viscosity, dp_drho_reference)
            }
            Transport::Helium => helium::critical::conductivity_w_m_k(state, viscosity),
            Transport::Mixture(_) => D::from(0.0),
        }
    }

    /// Temperature from which on the critical enhancement is zero, K, and at which its reference derivative
    /// is to be taken. `None`: there is no such derivative; the enhancement of helium, zero from 12 K on,
    /// ignores it.
    #[inline]
    pub(crate) fn reference_temperature_k(&self) -> Option<f64> {
        match self {
            Transport::LemmonJacobsen(data) => Some(data.critical.reference_temperature_k),
            Transport::Hydrogen => Some(hydrogen::CRITICAL.reference_temperature_k),
            Transport::CarbonDioxide => Some(carbon_dioxide::CRITICAL.reference_temperature_k),
            Transport::Helium => None,
            Transport::Mixture(_) => Some(0.0),
        }
    }
}
