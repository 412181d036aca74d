//! Helium: coefficients of the equation of state.
//!
//! Equation of state: D. O. Ortiz-Vega, "A new wide range equation of state for helium-4", PhD thesis, Texas A&M University
//! (2013), as later published with K. R. Hall, J. C. Holste, V. D. Arp, A. H. Harvey, E. W. Lemmon,
//! J. Phys. Chem. Ref. Data 49 (2020) 033105 (project coefficients: CoolProp 8.0.0).
//! Transport: see [`crate::fluid::transport`].
use crate::fluid::data::terms::{FluidData, GaussianTerm as G, Melting, PowerTerm as P};
use crate::fluid::transport::Transport;
use alloc::borrow::Cow::Borrowed;

/// Helium.
pub(super) static HELIUM: FluidData = FluidData {
    name: "helium",
    also: &["he"],
    reference: "Ortiz-Vega et al., helium-4 (2013)",
    gas_constant_j_mol_k: 8.3144598,
    molar_mass_kg_mol: 0.004002602,
    reducing_temperature_k: 5.1953,
    reducing_density_mol_m3: 17383.7,
    critical_temperature_k: 5.1953000000000005,
    critical_pressure_pa: 228326.06990902807,
    acentric_factor: -0.38353992538323034,
    lowest_temperature_k: 2.1768,
    highest_temperature_k: 1500.0,
    highest_pressure_pa: 1000000000.0,
    triple_liquid_density_mol_m3: 36480.345,
    // Datchi, Loubeyre, LeToullec, Phys. Rev. B 61 (2000) 6535.
    melting: Melting { temperature_k: 1.0, pressure_pa: -1_606_700.0, terms: &[(1_606_700.0, 1.565)] },
    power: Borrowed(&[
        P { n: 0.015559018, d: 4, t: 1.0, l: 0 },
        P { n: 3.0638932, d: 1, t: 0.425, l: 0 },
        P { n: -4.2420844, d: 1, t: 0.63, l: 0 },
        P { n: 0.054418088, d: 2, t: 0.69, l: 0 },
        P { n: -0.18971904, d: 2, t: 1.83, l: 0 },
        P { n: 0.087856262, d: 3, t: 0.575, l: 0 },
        P { n: 2.2833566, d: 1, t: 0.925, l: 1 },
        P { n: -0.53331595, d: 1, t: 1.585, l: 2 },
        P { n: -0.53296502, d: 3, t: 1.69, l: 2 },
        P { n: 0.99444915, d: 2, t: 1.51, l: 1 },
        P { n: -0.30078896, d: 2, t: 2.9, l: 2 },
        P { n: -1.6432563, d: 1, t: 0.8, l: 1 },
    ]),
    gaussian: Borrowed(&[
        G { n: 0.8029102, d: 2, t: 1.26, eta: 1.5497, beta: 0.2471, gamma: 3.15, epsilon: 0.596 },
        G { n: 0.026838669, d: 1, t: 3.51, eta: 9.245, beta: 0.0983, gamma: 2.54505, epsilon: 0.3423 },
        G { n: 0.04687678, d: 2, t: 2.785, eta: 4.76323, beta: 0.1556, gamma: 1.2513, epsilon: 0.761 },
        G { n: -0.14832766, d: 1, t: 1.0, eta: 6.3826, beta: 2.6782, gamma: 1.9416, epsilon: 0.9747 },
        G { n: 0.03016211, d: 1, t: 4.22, eta: 8.7023, beta: 2.7077, gamma: 0.5984, epsilon: 0.5868 },
        G { n: -0.019986041, d: 3, t: 0.83, eta: 0.255, beta: 0.6621, gamma: 2.2282, epsilon: 0.5627 },
        G { n: 0.14283514, d: 2, t: 1.575, eta: 0.3523, beta: 0.1775, gamma: 1.606, epsilon: 2.5346 },
        G { n: 0.007418269, d: 2, t: 3.447, eta: 0.1492, beta: 0.4821, gamma: 3.815, epsilon: 3.6763 },
        G { n: -0.22989793, d: 3, t: 0.73, eta: 0.05, beta: 0.3069, gamma: 1.61958, epsilon: 4.5245 },
        G { n: 0.79224829, d: 2, t: 1.634, eta: 0.1668, beta: 0.1758, gamma: 0.6407, epsilon: 5.039 },
        G { n: -0.049386338, d: 2, t: 6.13, eta: 42.2358, beta: 1357.6577, gamma: 1.076, epsilon: 0.959 },
    ]),
    nonanalytic: Borrowed(&[]),
    departure: Borrowed(&[]),
    ideal_constant: 0.17324879328357912,
    ideal_tau: 0.4674522201551032,
    ideal_ln_tau: 1.5,
    ideal_power: Borrowed(&[]),
    ideal_einstein: Borrowed(&[]),
    ideal_general: Borrowed(&[]),
    transport: Transport::Helium,
};
