//! Viscosity and thermal conductivity of a mixture, from those of its components.
//!
//! Dilute gas: `eta_0 = sum x_i eta_i / sum_j x_j phi_ij`, `lambda_0` alike with the same `phi_ij` (Wilke; Wassiljewa with Mason and Saxena),
//! `phi_ij = [1 + (eta_i/eta_j)^(1/2) (M_j/M_i)^(1/4)]^2 / [8 (1 + M_i/M_j)]^(1/2)`.
//! Dense gas: the residual parts of the components at the same reduced density and the same temperature, `sum x_i eta_r,i(delta rho_c,i, T)`.
//! The enhancement near the critical point is left out: it lies below the temperatures of a mixture's domain.
//!
//! # Validity
//!
//! Gas above 1.3 reducing temperatures. 5 % in viscosity and conductivity: air made of nitrogen, oxygen and argon deviates from the
//! correlation of air by up to 4.0 % and 1.8 % from 220 to 350 K and up to 500 bar, and by 1.5 % in the conductivity of the dilute gas.
//!
//! # References
//!
//! Wilke, J. Chem. Phys. 18 (1950) 517, doi 10.1063/1.1747673. Mason, Saxena, Phys. Fluids 1 (1958) 361, doi 10.1063/1.1724352.
use super::Transport;
use crate::fluid::Real;
use alloc::vec::Vec;

/// A component of a mixture.
#[derive(Clone, Debug)]
pub(crate) struct MixtureComponent {
    /// Mole fraction.
    pub fraction: f64,
    /// Molar mass, kg/mol.
    pub molar_mass_kg_mol: f64,
    /// Reducing density, kg/m³.
    pub reducing_density_kg_m3: f64,
    /// Its own correlations.
    pub transport: Transport,
}

/// Components and reducing density of a mixture.
#[derive(Clone, Debug)]
pub(crate) struct MixtureTransport {
    /// Reducing density, kg/m³.
    pub reducing_density_kg_m3: f64,
    /// Components, at most [`MOST`].
    pub components: Vec<MixtureComponent>,
}

/// Most components.
const MOST: usize = 6;

impl MixtureTransport {
    /// Viscosity, Pa s. Out of line, as is the other: pure gases do not pay for it.
    #[cold]
    #[inline(never)]
    pub(super) fn viscosity_pa_s<D: Real>(&self, rho: D, t: D) -> D {
        let dilute = self.dilute_viscosity(t);
        self.mixed(rho, &dilute, &dilute, |component, rho| component.viscosity_pa_s(rho, t))
    }

    /// Thermal conductivity, W/(m K).
    #[cold]
    #[inline(never)]
    pub(super) fn conductivity_w_m_k<D: Real>(&self, rho: D, t: D) -> D {
        let mut dilute = [D::from(0.0); MOST];
        for (value, component) in dilute.iter_mut().zip(&self.components) {
            *value = component.transport.background_conductivity_w_m_k(D::from(0.0), t);
        }
        self.mixed(rho, &self.dilute_viscosity(t), &dilute, |component, rho| {
            component.background_conductivity_w_m_k(rho, t)
        })
    }

    fn dilute_viscosity<D: Real>(&self, t: D) -> [D; MOST] {
        let mut dilute = [D::from(0.0); MOST];
        for (value, component) in dilute.iter_mut().zip(&self.components) {
            *value = component.transport.viscosity_pa_s(D::from(0.0), t);
        }
        dilute
    }

    /// The mixing rule of the dilute values and the sum of the residual parts.
    fn mixed<D: Real>(
        &self,
        rho: D,
        viscosity: &[D; MOST],
        dilute: &[D; MOST],
        dense: impl Fn(&Transport, D) -> D,
    ) -> D {
        let delta = rho / self.reducing_density_kg_m3;
        let mut sum = D::from(0.0);
        for (i, one) in self.components.iter().enumerate() {
            let mut weight = D::from(0.0);
            for (j, other) in self.components.iter().enumerate() {
                let ratio = other.molar_mass_kg_mol / one.molar_mass_kg_mol;
                let root = (viscosity[i] / viscosity[j]).sqrt() * libm::sqrt(libm::sqrt(ratio)) + 1.0;
                weight += root * root * (other.fraction / libm::sqrt(8.0 * (1.0 + ratio.recip())));
            }
            let residual = dense(&one.transport, delta * one.reducing_density_kg_m3) - dilute[i];
            sum += (dilute[i] / weight + residual) * one.fraction;
        }
        sum
    }
}
