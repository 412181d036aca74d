//! Carbon dioxide: coefficients of the equation of state.
//!
//! Equation of state: R. Span, W. Wagner, "A new equation of state for carbon dioxide covering the fluid region from the
//! triple-point temperature to 1100 K at pressures up to 800 MPa", J. Phys. Chem. Ref. Data 25 (1996) 1509,
//! doi:10.1063/1.555991. Critical density 467.6 kg/m³.
//! Transport: see [`crate::fluid::transport`].
use crate::fluid::data::terms::{
    FluidData, GaussianTerm as G, Melting, NonanalyticTerm as N, PowerTerm as P,
};
use crate::fluid::transport::Transport;
use alloc::borrow::Cow::Borrowed;

/// Pressure at the triple point, Pa.
const TRIPLE_PA: f64 = 517_950.0;

/// Carbon dioxide.
pub(super) static CARBON_DIOXIDE: FluidData = FluidData {
    name: "carbon-dioxide",
    also: &["co2", "r744", "carbondioxide", "carbonic-acid"],
    reference: "Span, Wagner, J. Phys. Chem. Ref. Data 25 (1996) 1509",
    gas_constant_j_mol_k: 8.31451,
    molar_mass_kg_mol: 0.0440098,
    reducing_temperature_k: 304.1282,
    reducing_density_mol_m3: 10624.9063,
    critical_temperature_k: 304.1282,
    critical_pressure_pa: 7377300.0,
    acentric_factor: 0.22394,
    lowest_temperature_k: 216.592,
    highest_temperature_k: 1100.0,
    highest_pressure_pa: 800000000.0,
    triple_liquid_density_mol_m3: 26777.28,
    // Equation 3.10 of the source, p_t [1 + a (T/T_t - 1) + b (T/T_t - 1)^2], expanded.
    melting: Melting {
        temperature_k: 216.592,
        pressure_pa: TRIPLE_PA,
        terms: &[(TRIPLE_PA * (1955.5390 - 2.0 * 2055.4593), 1.0), (TRIPLE_PA * 2055.4593, 2.0)],
    },
    power: Borrowed(&[
        P { n: 0.38856823203161, d: 1, t: 0.0, l: 0 },
        P { n: 2.938547594274, d: 1, t: 0.75, l: 0 },
        P { n: -5.5867188534934, d: 1, t: 1.0, l: 0 },
        P { n: -0.76753199592477, d: 1, t: 2.0, l: 0 },
        P { n: 0.31729005580416, d: 2, t: 0.75, l: 0 },
        P { n: 0.54803315897767, d: 2, t: 2.0, l: 0 },
        P { n: 0.12279411220335, d: 3, t: 0.75, l: 0 },
        P { n: 2.165896154322, d: 1, t: 1.5, l: 1 },
        P { n: 1.5841735109724, d: 2, t: 1.5, l: 1 },
        P { n: -0.23132705405503, d: 4, t: 2.5, l: 1 },
        P { n: 0.058116916431436, d: 5, t: 0.0, l: 1 },
        P { n: -0.55369137205382, d: 5, t: 1.5, l: 1 },
        P { n: 0.48946615909422, d: 5, t: 2.0, l: 1 },
        P { n: -0.024275739843501, d: 6, t: 0.0, l: 1 },
        P { n: 0.062494790501678, d: 6, t: 1.0, l: 1 },
        P { n: -0.12175860225246, d: 6, t: 2.0, l: 1 },
        P { n: -0.37055685270086, d: 1, t: 3.0, l: 2 },
        P { n: -0.016775879700426, d: 1, t: 6.0, l: 2 },
        P { n: -0.11960736637987, d: 4, t: 3.0, l: 2 },
        P { n: -0.045619362508778, d: 4, t: 6.0, l: 2 },
        P { n: 0.035612789270346, d: 4, t: 8.0, l: 2 },
        P { n: -0.0074427727132052, d: 7, t: 6.0, l: 2 },
        P { n: -0.0017395704902432, d: 8, t: 0.0, l: 2 },
        P { n: -0.021810121289527, d: 2, t: 7.0, l: 3 },
        P { n: 0.024332166559236, d: 3, t: 12.0, l: 3 },
        P { n: -0.037440133423463, d: 3, t: 16.0, l: 3 },
        P { n: 0.14338715756878, d: 5, t: 22.0, l: 4 },
        P { n: -0.13491969083286, d: 5, t: 24.0, l: 4 },
        P { n: -0.02315122505348, d: 6, t: 16.0, l: 4 },
        P { n: 0.012363125492901, d: 7, t: 24.0, l: 4 },
        P { n: 0.002105832197294, d: 8, t: 8.0, l: 4 },
        P { n: -0.00033958519026368, d: 10, t: 2.0, l: 4 },
        P { n: 0.0055993651771592, d: 4, t: 28.0, l: 5 },
        P { n: -0.00030335118055646, d: 8, t: 14.0, l: 6 },
    ]),
    gaussian: Borrowed(&[
        G { n: -213.6548868832, d: 2, t: 1.0, eta: 25.0, beta: 325.0, gamma: 1.16, epsilon: 1.0 },
        G { n: 26641.569149272, d: 2, t: 0.0, eta: 25.0, beta: 300.0, gamma: 1.19, epsilon: 1.0 },
        G { n: -24027.212204557, d: 2, t: 1.0, eta: 25.0, beta: 300.0, gamma: 1.19, epsilon: 1.0 },
        G { n: -283.41603423999, d: 3, t: 3.0, eta: 15.0, beta: 275.0, gamma: 1.25, epsilon: 1.0 },
        G { n: 212.47284400179, d: 3, t: 3.0, eta: 20.0, beta: 275.0, gamma: 1.22, epsilon: 1.0 },
    ]),
    nonanalytic: Borrowed(&[
        N {
            n: -0.66642276540751,
            b: 0.875,
            a: 3.5,
            beta: 0.3,
            amplitude: 0.7,
            width: 0.3,
            eta: 10.0,
            decay: 275.0,
        },
        N {
            n: 0.72608632349897,
            b: 0.925,
            a: 3.5,
            beta: 0.3,
            amplitude: 0.7,
            width: 0.3,
            eta: 10.0,
            decay: 275.0,
        },
        N {
            n: 0.055068668612842,
            b: 0.875,
            a: 3.0,
            beta: 0.3,
            amplitude: 0.7,
            width: 1.0,
            eta: 12.5,
            decay: 275.0,
        },
    ]),
    departure: Borrowed(&[]),
    ideal_constant: 8.37304456,
    ideal_tau: -3.70454304,
    ideal_ln_tau: 2.5,
    ideal_power: Borrowed(&[]),
    ideal_einstein: Borrowed(&[
        (1.99427042, 3.15163),
        (0.62105248, 6.1119),
        (0.41195293, 6.77708),
        (1.04028922, 11.32384),
        (0.08327678, 27.08792),
    ]),
    ideal_general: Borrowed(&[]),
    transport: Transport::CarbonDioxide,
};
