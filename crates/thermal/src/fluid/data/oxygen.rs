//! Oxygen: coefficients of the equation of state and of transport.
//!
//! Equation of state: R. B. Stewart, R. T Jacobsen, W. Wagner, "Thermodynamic properties of oxygen from the triple point to 300 K with pressures to 80 MPa", J. Phys. Chem. Ref. Data 20 (1991)
//! 917, doi:10.1063/1.555897, the equation of R. Schmidt, W. Wagner, Fluid Phase Equilib. 19 (1985) 175, doi:10.1016/0378-3812(85)87016-3. It was fitted up to 300 K; from there to 450 K it
//! extrapolates, as a filled cylinder in the sun needs and as CoolProp does.
//! Transport: E. W. Lemmon, R. T Jacobsen, Int. J. Thermophys. 25 (2004) 21, doi:10.1023/B:IJOT.0000022327.04529.f3; µPa s, mW/(m K), nm, g/mol. Digits as CoolProp 8.0.0 distributes them.
use crate::fluid::data::terms::{FluidData, Melting, PowerTerm as P};
use crate::fluid::transport::{LemmonJacobsenData, OlchowySengers, Term as T, Transport};
use alloc::borrow::Cow::Borrowed;

/// Oxygen.
// 6.283 is a coefficient of the source, not two pi.
#[expect(clippy::approx_constant)]
pub(super) static OXYGEN: FluidData = FluidData {
    name: "oxygen",
    also: &["o2"],
    reference: "Stewart, Jacobsen, Wagner, J. Phys. Chem. Ref. Data 20 (1991) 917",
    gas_constant_j_mol_k: 8.31434,
    molar_mass_kg_mol: 0.0319988,
    reducing_temperature_k: 154.581,
    reducing_density_mol_m3: 13630.0,
    critical_temperature_k: 154.581,
    critical_pressure_pa: 5043000.0,
    acentric_factor: 0.0222,
    lowest_temperature_k: 54.361,
    highest_temperature_k: 450.0,
    highest_pressure_pa: 80000000.0,
    triple_liquid_density_mol_m3: 40816.43,
    // Younglove, J. Phys. Chem. Ref. Data 11 Suppl. 1 (1982).
    melting: Melting { temperature_k: 1.0, pressure_pa: -266_999_247.652, terms: &[(227_606.348, 1.769)] },
    power: Borrowed(&[
        P { n: 0.3983768749, d: 1, t: 0.0, l: 0 },
        P { n: -1.846157454, d: 1, t: 1.5, l: 0 },
        P { n: 0.4183473197, d: 1, t: 2.5, l: 0 },
        P { n: 0.02370620711, d: 2, t: -0.5, l: 0 },
        P { n: 0.09771730573, d: 2, t: 1.5, l: 0 },
        P { n: 0.03017891294, d: 2, t: 2.0, l: 0 },
        P { n: 0.02273353212, d: 3, t: 0.0, l: 0 },
        P { n: 0.01357254086, d: 3, t: 1.0, l: 0 },
        P { n: -0.04052698943, d: 3, t: 2.5, l: 0 },
        P { n: 0.0005454628515, d: 6, t: 0.0, l: 0 },
        P { n: 0.0005113182277, d: 7, t: 2.0, l: 0 },
        P { n: 2.953466883e-07, d: 7, t: 5.0, l: 0 },
        P { n: -8.687645072e-05, d: 8, t: 2.0, l: 0 },
        P { n: -0.2127082589, d: 1, t: 5.0, l: 2 },
        P { n: 0.08735941958, d: 1, t: 6.0, l: 2 },
        P { n: 0.127550919, d: 2, t: 3.5, l: 2 },
        P { n: -0.09067701064, d: 2, t: 5.5, l: 2 },
        P { n: -0.03540084206, d: 3, t: 3.0, l: 2 },
        P { n: -0.03623278059, d: 3, t: 7.0, l: 2 },
        P { n: 0.0132769929, d: 5, t: 6.0, l: 2 },
        P { n: -0.0003254111865, d: 6, t: 8.5, l: 2 },
        P { n: -0.008313582932, d: 7, t: 4.0, l: 2 },
        P { n: 0.002124570559, d: 8, t: 6.5, l: 2 },
        P { n: -0.0008325206232, d: 10, t: 5.5, l: 2 },
        P { n: -2.626173276e-05, d: 2, t: 22.0, l: 4 },
        P { n: 0.002599581482, d: 3, t: 11.0, l: 4 },
        P { n: 0.009984649663, d: 3, t: 18.0, l: 4 },
        P { n: 0.002199923153, d: 4, t: 11.0, l: 4 },
        P { n: -0.02591350486, d: 4, t: 23.0, l: 4 },
        P { n: -0.1259630848, d: 5, t: 17.0, l: 4 },
        P { n: 0.1478355637, d: 5, t: 18.0, l: 4 },
        P { n: -0.01011251078, d: 5, t: 23.0, l: 4 },
    ]),
    gaussian: Borrowed(&[]),
    nonanalytic: Borrowed(&[]),
    departure: Borrowed(&[]),
    ideal_constant: -14.716836666461498,
    ideal_tau: -0.011083985429237124,
    ideal_ln_tau: 2.51808732,
    ideal_power: Borrowed(&[]),
    ideal_einstein: Borrowed(&[
        (1.02323928, 14.5316979447668),
        (0.784357918, 72.8419165356674),
        (0.00337183363, 7.7710849975094),
        (-0.0170864084, 0.446425786480874),
        (0.0463751562, 34.4677188658373),
    ]),
    ideal_general: Borrowed(&[]),
    transport: Transport::LemmonJacobsen(&LemmonJacobsenData {
        molar_mass_g_mol: 31.9988,
        epsilon_over_k_k: 118.5,
        sigma_nm: 0.3428,
        reducing_temperature_k: 154.581,
        reducing_density_kg_m3: 13630.0 * 0.0319988,
        viscosity: &[
            T::new(17.67, 0.05, 1, 0),
            T::new(0.4042, 0.0, 5, 0),
            T::new(0.0001077, 2.1, 12, 0),
            T::new(0.351, 0.0, 8, 1),
            T::new(-13.67, 0.5, 1, 2),
        ],
        dilute_from_viscosity: 1.036,
        dilute: &[[6.283, -0.9], [-4.262, -0.6]],
        conductivity: &[
            T::new(15.31, 0.0, 1, 0),
            T::new(8.898, 0.0, 3, 0),
            T::new(-0.7336, 0.3, 4, 0),
            T::new(6.728, 4.3, 5, 2),
            T::new(-4.374, 0.5, 7, 2),
            T::new(-0.4747, 1.8, 10, 2),
        ],
        critical: OlchowySengers {
            xi_0_m: 2.4e-10,
            amplitude: 0.055,
            strength: 1.01,
            gamma: 1.2415,
            cutoff_per_m: 1.0 / 0.51e-9,
            reference_temperature_k: 309.162,
            critical_pressure_pa: 5043000.0,
            critical_density_kg_m3: 13630.0 * 0.0319988,
        },
    }),
};
