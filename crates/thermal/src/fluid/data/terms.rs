//! What an equation of state is made of: its terms, its range, its constants.
use alloc::borrow::Cow;

use crate::fluid::transport::Transport;

/// Term `n delta^d tau^t exp(-delta^l)`; no exponential for `l = 0`.
#[derive(Clone, Copy, Debug)]
pub(in crate::fluid) struct PowerTerm {
    /// Coefficient.
    pub n: f64,
    /// Exponent of the reduced density.
    pub d: u8,
    /// Exponent of the inverse reduced temperature.
    pub t: f64,
    /// Exponent inside the exponential.
    pub l: u8,
}

/// Term `n delta^d tau^t exp(-eta (delta - epsilon)^2 - beta (tau - gamma)^2)`.
#[derive(Clone, Copy, Debug)]
pub(in crate::fluid) struct GaussianTerm {
    /// Coefficient.
    pub n: f64,
    /// Exponent of the reduced density.
    pub d: u8,
    /// Exponent of the inverse reduced temperature.
    pub t: f64,
    /// Width in density.
    pub eta: f64,
    /// Width in inverse temperature.
    pub beta: f64,
    /// Centre in inverse temperature.
    pub gamma: f64,
    /// Centre in density.
    pub epsilon: f64,
}

/// Term `n delta Delta^b Psi` of Span and Wagner about the critical point, with
/// `Psi = exp(-C (delta-1)^2 - D (tau-1)^2)`, `Delta = theta^2 + B [(delta-1)^2]^a`,
/// `theta = (1-tau) + A [(delta-1)^2]^(1/(2 beta))`.
#[derive(Clone, Copy, Debug)]
pub(in crate::fluid) struct NonanalyticTerm {
    /// Coefficient.
    pub n: f64,
    /// Exponent of the distance.
    pub b: f64,
    /// Exponent in density inside the distance.
    pub a: f64,
    /// Exponent `beta` of the coexistence curve.
    pub beta: f64,
    /// `A`.
    pub amplitude: f64,
    /// `B`.
    pub width: f64,
    /// `C`.
    pub eta: f64,
    /// `D`.
    pub decay: f64,
}

/// Term `n delta^d tau^t exp(-eta (delta-epsilon)^2 - beta (delta-gamma))` of a departure function.
#[derive(Clone, Copy, Debug)]
pub(in crate::fluid) struct DepartureTerm {
    /// Coefficient.
    pub n: f64,
    /// Exponent of the reduced density.
    pub d: u8,
    /// Exponent of the inverse reduced temperature.
    pub t: f64,
    /// Width in density.
    pub eta: f64,
    /// Centre in density.
    pub epsilon: f64,
    /// Decay in density.
    pub beta: f64,
    /// Density where the decay is one.
    pub gamma: f64,
}

/// Melting pressure `p_0 + sum a [(T/T_0)^t - 1]`: above it the fluid is solid.
#[derive(Clone, Copy, Debug)]
pub(in crate::fluid) struct Melting {
    /// `T_0`, K.
    pub temperature_k: f64,
    /// `p_0`, Pa.
    pub pressure_pa: f64,
    /// Terms (a in Pa, t).
    pub terms: &'static [(f64, f64)],
}

impl Melting {
    /// Melting pressure at a temperature, Pa.
    pub(crate) fn pressure_pa(&self, temperature_k: f64) -> f64 {
        let ratio = temperature_k / self.temperature_k;
        self.pressure_pa + self.terms.iter().map(|&(a, t)| a * (libm::pow(ratio, t) - 1.0)).sum::<f64>()
    }
}

/// A fundamental equation `a / (R T) = alpha0 + alphar` and its range of validity.
#[derive(Clone, Debug)]
pub(in crate::fluid) struct FluidData {
    /// Name as files spell it.
    pub name: &'static str,
    /// Other names that people type: refused, and answered with the one above.
    pub also: &'static [&'static str],
    /// Source in short.
    pub reference: &'static str,
    /// Gas constant that the equation was fitted with, J/(mol K).
    pub gas_constant_j_mol_k: f64,
    /// Molar mass, kg/mol.
    pub molar_mass_kg_mol: f64,
    /// Reducing temperature, K.
    pub reducing_temperature_k: f64,
    /// Reducing density, mol/m³.
    pub reducing_density_mol_m3: f64,
    /// Critical temperature, K; above it there is one phase. A mixture's is that of its cubic equation.
    pub critical_temperature_k: f64,
    /// Critical pressure, Pa.
    pub critical_pressure_pa: f64,
    /// Acentric factor (for Peng-Robinson).
    pub acentric_factor: f64,
    /// Lowest temperature, K.
    pub lowest_temperature_k: f64,
    /// Highest temperature, K.
    pub highest_temperature_k: f64,
    /// Highest pressure, Pa.
    pub highest_pressure_pa: f64,
    /// Density of the liquid at the triple point, mol/m³: where a search from the dense side starts.
    pub triple_liquid_density_mol_m3: f64,
    /// Melting line.
    pub melting: Melting,
    /// Polynomial and exponential terms of the residual part.
    pub power: Cow<'static, [PowerTerm]>,
    /// Gaussian terms of the residual part.
    pub gaussian: Cow<'static, [GaussianTerm]>,
    /// Terms about the critical point.
    pub nonanalytic: Cow<'static, [NonanalyticTerm]>,
    /// Departure functions of a mixture.
    pub departure: Cow<'static, [DepartureTerm]>,
    /// Constant of the ideal part.
    pub ideal_constant: f64,
    /// Coefficient of `tau` in the ideal part.
    pub ideal_tau: f64,
    /// Coefficient of `ln tau` in the ideal part.
    pub ideal_ln_tau: f64,
    /// Terms `n tau^t` of the ideal part as (n, t).
    pub ideal_power: Cow<'static, [(f64, f64)]>,
    /// Terms `n ln(1 - exp(-t tau))` of the ideal part as (n, t).
    pub ideal_einstein: Cow<'static, [(f64, f64)]>,
    /// Terms `n ln(c + d exp(t tau))` of the ideal part as (n, t, c, d).
    pub ideal_general: Cow<'static, [(f64, f64, f64, f64)]>,
    /// Viscosity and thermal conductivity.
    pub transport: Transport,
}
