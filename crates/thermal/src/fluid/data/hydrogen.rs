//! Hydrogen: coefficients of the equation of state.
//!
//! Equation of state: J. W. Leachman, R. T Jacobsen, S. G. Penoncello, E. W. Lemmon, "Fundamental equations of state for
//! parahydrogen, normal hydrogen, and orthohydrogen", J. Phys. Chem. Ref. Data 38 (2009) 721, doi:10.1063/1.3160306: normal hydrogen.
//! Transport: see [`crate::fluid::transport`].
use crate::fluid::data::terms::{FluidData, GaussianTerm as G, Melting, PowerTerm as P};
use crate::fluid::transport::Transport;
use alloc::borrow::Cow::Borrowed;

/// Hydrogen.
pub(super) static HYDROGEN: FluidData = FluidData {
    name: "hydrogen",
    also: &["h2"],
    reference: "Leachman et al., J. Phys. Chem. Ref. Data 38 (2009) 721",
    gas_constant_j_mol_k: 8.314472,
    molar_mass_kg_mol: 0.00201588,
    reducing_temperature_k: 33.145,
    reducing_density_mol_m3: 15508.0,
    critical_temperature_k: 33.145,
    critical_pressure_pa: 1296400.0,
    acentric_factor: -0.219,
    lowest_temperature_k: 13.957,
    highest_temperature_k: 1000.0,
    highest_pressure_pa: 2000000000.0,
    triple_liquid_density_mol_m3: 38198.542,
    // Datchi, Loubeyre, LeToullec, Phys. Rev. B 61 (2000) 6535.
    melting: Melting { temperature_k: 1.0, pressure_pa: -236_200.0, terms: &[(231_000.0, 1.7627)] },
    power: Borrowed(&[
        P { n: -6.93643, d: 1, t: 0.6844, l: 0 },
        P { n: 0.01, d: 4, t: 1.0, l: 0 },
        P { n: 2.1101, d: 1, t: 0.989, l: 0 },
        P { n: 4.52059, d: 1, t: 0.489, l: 0 },
        P { n: 0.732564, d: 2, t: 0.803, l: 0 },
        P { n: -1.34086, d: 2, t: 1.1444, l: 0 },
        P { n: 0.130985, d: 3, t: 1.409, l: 0 },
        P { n: -0.777414, d: 1, t: 1.754, l: 1 },
        P { n: 0.351944, d: 3, t: 1.311, l: 1 },
    ]),
    gaussian: Borrowed(&[
        G { n: -0.0211716, d: 2, t: 4.187, eta: 1.685, beta: 0.171, gamma: 0.7164, epsilon: 1.506 },
        G { n: 0.0226312, d: 1, t: 5.646, eta: 0.489, beta: 0.2245, gamma: 1.3444, epsilon: 0.156 },
        G { n: 0.032187, d: 3, t: 0.791, eta: 0.103, beta: 0.1304, gamma: 1.4517, epsilon: 1.736 },
        G { n: -0.0231752, d: 1, t: 7.249, eta: 2.506, beta: 0.2785, gamma: 0.7204, epsilon: 0.67 },
        G { n: 0.0557346, d: 1, t: 2.986, eta: 1.607, beta: 0.3967, gamma: 1.5445, epsilon: 1.662 },
    ]),
    nonanalytic: Borrowed(&[]),
    departure: Borrowed(&[]),
    ideal_constant: -1.4579856475,
    ideal_tau: 1.888076782,
    ideal_ln_tau: 1.5,
    ideal_power: Borrowed(&[]),
    ideal_einstein: Borrowed(&[
        (1.616, 16.020515914919294),
        (-0.4117, 22.658017800573237),
        (-0.792, 60.00905113893498),
        (0.758, 74.94343038165636),
        (1.217, 206.93920651682),
    ]),
    ideal_general: Borrowed(&[]),
    transport: Transport::Hydrogen,
};
