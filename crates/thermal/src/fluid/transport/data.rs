//! Coefficients of Lemmon and Jacobsen (2004) for nitrogen, argon and air.
//!
//! Units of the source: µPa s, mW/(m K), nm, g/mol. Densities are reduced in mol/m³ there; the molar mass that
//! makes them kg/m³ is that of the equation of state, which for air (28.965 46 g/mol) differs from the one
//! within the dilute viscosity (28.958 6 g/mol).
//!
//! Source: Int. J. Thermophys. 25 (2004) 21, doi 10.1023/B:IJOT.0000022327.04529.f3, in the
//! digits CoolProp 8.0.0 distributes (TRANSPORT section of its fluid files).
use super::{LemmonJacobsenData, OlchowySengers, Term};

const fn term(n: f64, t: f64, d: u32, l: usize) -> Term {
    Term { n, t, d, l }
}

/// Nitrogen.
pub(super) static NITROGEN: LemmonJacobsenData = LemmonJacobsenData {
    molar_mass_g_mol: 28.01348,
    epsilon_over_k_k: 98.94,
    sigma_nm: 0.3656,
    reducing_temperature_k: 126.192,
    reducing_density_kg_m3: 11183.9 * 0.02801348,
    viscosity: &[
        term(10.72, 0.1, 2, 0),
        term(0.03989, 0.25, 10, 1),
        term(0.001208, 3.2, 12, 1),
        term(-7.402, 0.9, 2, 2),
        term(4.62, 0.3, 1, 3),
    ],
    dilute_from_viscosity: 1.511,
    dilute: &[[2.117, -1.0], [-3.332, -0.7]],
    conductivity: &[
        term(8.862, 0.0, 1, 0),
        term(31.11, 0.03, 2, 0),
        term(-73.13, 0.2, 3, 1),
        term(20.03, 0.8, 4, 2),
        term(-0.7096, 0.6, 8, 2),
        term(0.2672, 1.9, 10, 2),
    ],
    critical: OlchowySengers {
        xi_0_m: 1.7e-10,
        amplitude: 0.055,
        cutoff_per_m: 1.0 / 0.4e-9,
        reference_temperature_k: 252.384,
        critical_pressure_pa: 3395800.0,
        critical_density_kg_m3: 11183.9 * 0.02801348,
    },
};

/// Argon.
pub(super) static ARGON: LemmonJacobsenData = LemmonJacobsenData {
    molar_mass_g_mol: 39.948,
    epsilon_over_k_k: 143.2,
    sigma_nm: 0.335,
    reducing_temperature_k: 150.687,
    reducing_density_kg_m3: 13407.43 * 0.039948,
    viscosity: &[
        term(12.19, 0.42, 1, 0),
        term(13.99, 0.0, 2, 0),
        term(0.005027, 0.95, 10, 0),
        term(-18.93, 0.5, 5, 2),
        term(-6.698, 0.9, 1, 4),
        term(-3.827, 0.8, 2, 4),
    ],
    dilute_from_viscosity: 0.8158,
    dilute: &[[-0.432, -0.77]],
    conductivity: &[
        term(13.73, 0.0, 1, 0),
        term(10.07, 0.0, 2, 0),
        term(0.7375, 0.0, 4, 0),
        term(-33.96, 0.8, 5, 2),
        term(20.47, 1.2, 6, 2),
        term(-2.274, 0.8, 9, 2),
        term(-3.973, 0.5, 1, 4),
    ],
    critical: OlchowySengers {
        xi_0_m: 1.3e-10,
        amplitude: 0.055,
        cutoff_per_m: 1.0 / 0.32e-9,
        reference_temperature_k: 301.374,
        critical_pressure_pa: 4863000.0,
        critical_density_kg_m3: 13407.43 * 0.039948,
    },
};

/// Air.
pub(super) static AIR: LemmonJacobsenData = LemmonJacobsenData {
    molar_mass_g_mol: 28.9586,
    epsilon_over_k_k: 103.3,
    sigma_nm: 0.36,
    reducing_temperature_k: 132.6312,
    reducing_density_kg_m3: 10447.7 * 0.02896546,
    viscosity: &[
        term(10.72, 0.2, 1, 0),
        term(1.122, 0.05, 4, 0),
        term(0.002019, 2.4, 9, 0),
        term(-8.876, 0.6, 1, 1),
        term(-0.02916, 3.6, 8, 1),
    ],
    dilute_from_viscosity: 1.308,
    dilute: &[[1.405, -1.1], [-1.036, -0.3]],
    conductivity: &[
        term(8.743, 0.1, 1, 0),
        term(14.76, 0.0, 2, 0),
        term(-16.62, 0.5, 3, 2),
        term(3.793, 2.7, 7, 2),
        term(-6.142, 0.3, 7, 2),
        term(-0.3778, 1.3, 11, 2),
    ],
    critical: OlchowySengers {
        xi_0_m: 1.1e-10,
        amplitude: 0.055,
        cutoff_per_m: 1.0 / 0.310000000001e-9,
        reference_temperature_k: 265.262,
        critical_pressure_pa: 3785020.0,
        critical_density_kg_m3: 10447.7 * 0.02896546,
    },
};
