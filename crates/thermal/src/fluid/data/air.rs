//! Dry air: coefficients of the equation of state.
//!
//! Equation of state: E. W. Lemmon, R. T Jacobsen, S. G. Penoncello, D. G. Friend, "Thermodynamic properties of air and
//! mixtures of nitrogen, argon, and oxygen from 60 to 2000 K at pressures to 2000 MPa", J. Phys. Chem. Ref. Data 29
//! (2000) 331, doi:10.1063/1.1285884: dry air as a pseudo-pure fluid, reduced at its maxcondentherm.
//! Transport: E. W. Lemmon, R. T. Jacobsen, Int. J. Thermophys. 25 (2004) 21, doi:10.1023/B:IJOT.0000022327.04529.f3, in the digits of CoolProp 8.0.0;
//! µPa s, mW/(m K), nm, g/mol.
use crate::fluid::data::terms::{FluidData, Melting, PowerTerm as P};
use crate::fluid::transport::{LemmonJacobsenData, OlchowySengers, Term as T, Transport};
use alloc::borrow::Cow::Borrowed;

/// Dry air.
pub(super) static AIR: FluidData = FluidData {
    name: "air",
    also: &[],
    reference: "Lemmon et al., J. Phys. Chem. Ref. Data 29 (2000) 331",
    gas_constant_j_mol_k: 8.31451,
    molar_mass_kg_mol: 0.02896546,
    reducing_temperature_k: 132.6312,
    reducing_density_mol_m3: 10447.7,
    critical_temperature_k: 132.5306,
    critical_pressure_pa: 3786000.0,
    acentric_factor: 0.0335,
    lowest_temperature_k: 59.75,
    highest_temperature_k: 2000.0,
    highest_pressure_pa: 2000000000.0,
    triple_liquid_density_mol_m3: 33066.642,
    // Lemmon et al. (2000).
    melting: Melting { temperature_k: 59.75, pressure_pa: 5264.181, terms: &[(186_844_210.8, 1.78963)] },
    power: Borrowed(&[
        P { n: 0.118160747229, d: 1, t: 0.0, l: 0 },
        P { n: 0.713116392079, d: 1, t: 0.33, l: 0 },
        P { n: -1.61824192067, d: 1, t: 1.01, l: 0 },
        P { n: 0.0714140178971, d: 2, t: 0.0, l: 0 },
        P { n: -0.0865421396646, d: 3, t: 0.0, l: 0 },
        P { n: 0.134211176704, d: 3, t: 0.15, l: 0 },
        P { n: 0.0112626704218, d: 4, t: 0.0, l: 0 },
        P { n: -0.0420533228842, d: 4, t: 0.2, l: 0 },
        P { n: 0.0349008431982, d: 4, t: 0.35, l: 0 },
        P { n: 0.000164957183186, d: 6, t: 1.35, l: 0 },
        P { n: -0.101365037912, d: 1, t: 1.6, l: 1 },
        P { n: -0.17381369097, d: 3, t: 0.8, l: 1 },
        P { n: -0.0472103183731, d: 5, t: 0.95, l: 1 },
        P { n: -0.0122523554253, d: 6, t: 1.25, l: 1 },
        P { n: -0.146629609713, d: 1, t: 3.6, l: 2 },
        P { n: -0.0316055879821, d: 3, t: 6.0, l: 2 },
        P { n: 0.000233594806142, d: 11, t: 3.25, l: 2 },
        P { n: 0.0148287891978, d: 1, t: 3.5, l: 3 },
        P { n: -0.00938782884667, d: 3, t: 15.0, l: 3 },
    ]),
    gaussian: Borrowed(&[]),
    nonanalytic: Borrowed(&[]),
    departure: Borrowed(&[]),
    ideal_constant: 10.3753039487406,
    ideal_tau: 3.31112445645577,
    ideal_ln_tau: 2.490888032,
    ideal_power: Borrowed(&[
        (6.057194e-08, -3.0),
        (-2.10274769e-05, -2.0),
        (-0.000158860716, -1.0),
        (-13.841928076, 0.0),
        (17.275266575, 1.0),
        (-0.00019536342, 1.5),
    ]),
    ideal_einstein: Borrowed(&[(0.791309509, 25.36365), (0.212236768, 16.90741)]),
    ideal_general: Borrowed(&[(-0.197938904, 87.31279, 0.6666666666666666, 1.0)]),
    transport: Transport::LemmonJacobsen(&LemmonJacobsenData {
        molar_mass_g_mol: 28.9586,
        epsilon_over_k_k: 103.3,
        sigma_nm: 0.36,
        reducing_temperature_k: 132.6312,
        reducing_density_kg_m3: 10447.7 * 0.02896546,
        viscosity: &[
            T::new(10.72, 0.2, 1, 0),
            T::new(1.122, 0.05, 4, 0),
            T::new(0.002019, 2.4, 9, 0),
            T::new(-8.876, 0.6, 1, 1),
            T::new(-0.02916, 3.6, 8, 1),
        ],
        dilute_from_viscosity: 1.308,
        dilute: &[[1.405, -1.1], [-1.036, -0.3]],
        conductivity: &[
            T::new(8.743, 0.1, 1, 0),
            T::new(14.76, 0.0, 2, 0),
            T::new(-16.62, 0.5, 3, 2),
            T::new(3.793, 2.7, 7, 2),
            T::new(-6.142, 0.3, 7, 2),
            T::new(-0.3778, 1.3, 11, 2),
        ],
        critical: OlchowySengers {
            xi_0_m: 1.1e-10,
            amplitude: 0.055,
            strength: 1.01,
            gamma: 1.2415,
            cutoff_per_m: 1.0 / 0.310000000001e-9,
            reference_temperature_k: 265.262,
            critical_pressure_pa: 3785020.0,
            critical_density_kg_m3: 10447.7 * 0.02896546,
        },
    }),
};
