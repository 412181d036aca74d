//! Mixtures of fixed composition by the mixture model GERG-2008, as data of one fluid.
//!
//! `alphar(delta, tau) = sum x_i alphar_i(delta, tau) + sum x_i x_j F_ij alphar_ij(delta, tau)`, `delta = rho / rho_r(x)`,
//! `tau = T_r(x) / T`; `T_r = sum x_i^2 T_i + sum_(i<j) 2 x_i x_j beta gamma (x_i+x_j)/(beta^2 x_i+x_j) sqrt(T_i T_j)`, and
//! `1/rho_r` alike with `(rho_i^(-1/3) + rho_j^(-1/3))^3 / 8`;
//! `alpha0 = sum x_i [alpha0_i(rho, T) + ln x_i]`, caloric parts times the gas constant of the component over that of the mixture.
//!
//! At a fixed composition all of it is again a sum of terms in `delta` and `tau`, so that a mixture is evaluated, solved and
//! checked as a pure fluid. The pure equations are the reference equations of the components, not the shorter ones of
//! GERG-2008; binary parameters are those of GERG-2008. With the van der Waals rules and `k_ij = 0` a mixture has the
//! Peng-Robinson equation of one fluid, too, whose critical point and acentric factor stand for the mixture.
//!
//! There is no phase equilibrium: the lowest temperature is a bound above which nothing condenses or freezes at any pressure.
//!
//! # References
//! O. Kunz, W. Wagner, "The GERG-2008 wide-range equation of state for natural gases and other mixtures: an expansion of
//! GERG-2004", J. Chem. Eng. Data 57 (2012) 3032, doi:10.1021/je300655b. Normal range 90 to 450 K and 35 MPa, extended to
//! 700 K and 70 MPa.
use crate::fluid::data::terms::{
    DepartureTerm as D, FluidData, GaussianTerm, Melting, NonanalyticTerm, PowerTerm,
};
use crate::fluid::peng_robinson;
use crate::fluid::transport::{MixtureComponent, MixtureTransport, Transport};
use alloc::borrow::Cow;
use alloc::sync::Arc;
use alloc::vec::Vec;

/// Gas constant, J/(mol K) (CODATA 2018, exact).
const GAS_CONSTANT_J_MOL_K: f64 = 8.314_462_618_153_24;
/// Upper bounds of the model's extended range.
const HIGHEST_TEMPERATURE_K: f64 = 700.0;
const HIGHEST_PRESSURE_PA: f64 = 70e6;

/// A mixture: its components and where it is one phase.
#[derive(Debug)]
pub(in crate::fluid) struct Mixture {
    /// Name as files spell it.
    pub name: &'static str,
    /// Other names that people type.
    pub also: &'static [&'static str],
    /// Source in short.
    pub reference: &'static str,
    /// Components with their mole fractions, which sum to 1.
    pub components: &'static [(&'static FluidData, f64)],
    /// Lowest temperature, K: above dew and frost points of every pressure.
    pub lowest_temperature_k: f64,
}

/// What two components have together.
struct Binary {
    /// Names, in the order that the betas belong to.
    pair: [&'static str; 2],
    /// `beta` and `gamma` of the reducing volume.
    volume: [f64; 2],
    /// `beta` and `gamma` of the reducing temperature.
    temperature: [f64; 2],
    /// Departure function, `F_ij` contained.
    departure: &'static [D],
}

/// Kunz and Wagner (2012), appendix.
static BINARIES: &[Binary] = &[
    Binary {
        pair: ["nitrogen", "argon"],
        volume: [1.004166412, 1.002212182],
        temperature: [0.999069843, 0.990034831],
        departure: &[],
    },
    Binary {
        pair: ["nitrogen", "oxygen"],
        volume: [0.999521770, 0.997082328],
        temperature: [0.997190589, 0.995157044],
        departure: &[],
    },
    Binary {
        pair: ["oxygen", "argon"],
        volume: [0.999746847, 0.993907223],
        temperature: [1.000023103, 0.990430423],
        departure: &[],
    },
    Binary {
        pair: ["carbon-dioxide", "argon"],
        volume: [1.008392428, 1.029205465],
        temperature: [0.996512863, 1.050971635],
        departure: &[],
    },
    Binary {
        pair: ["nitrogen", "carbon-dioxide"],
        volume: [0.977794634, 1.047578256],
        temperature: [1.005894529, 1.107654104],
        departure: &[
            D { n: 0.28661625028399, d: 2, t: 1.85, eta: 0.0, epsilon: 0.0, beta: 0.0, gamma: 0.0 },
            D { n: -0.10919833861247, d: 3, t: 1.4, eta: 0.0, epsilon: 0.0, beta: 0.0, gamma: 0.0 },
            D { n: -1.1374032082270, d: 1, t: 3.2, eta: 0.25, epsilon: 0.5, beta: 0.75, gamma: 0.5 },
            D { n: 0.76580544237358, d: 1, t: 2.5, eta: 0.25, epsilon: 0.5, beta: 1.0, gamma: 0.5 },
            D { n: 0.0042638000926819, d: 1, t: 8.0, eta: 0.0, epsilon: 0.5, beta: 2.0, gamma: 0.5 },
            D { n: 0.17673538204534, d: 2, t: 3.75, eta: 0.0, epsilon: 0.5, beta: 3.0, gamma: 0.5 },
        ],
    },
];

/// The pairs of a composition as (i, j, parameters), `i` the first of the parameters' pair.
fn pairs(components: &[(&'static FluidData, f64)]) -> Vec<(usize, usize, &'static Binary)> {
    let index = |name: &str| components.iter().position(|(data, _)| data.name == name);
    let found: Vec<_> = BINARIES
        .iter()
        .filter_map(|binary| Some((index(binary.pair[0])?, index(binary.pair[1])?, binary)))
        .collect();
    assert_eq!(found.len(), components.len() * (components.len() - 1) / 2, "binary parameters of every pair");
    found
}

/// `sum x_i^2 Y_i + sum 2 x_i x_j beta gamma (x_i+x_j)/(beta^2 x_i+x_j) Y_ij`.
fn reducing(
    components: &[(&'static FluidData, f64)],
    parameters: impl Fn(&Binary) -> [f64; 2],
    value: impl Fn(&FluidData, &FluidData) -> f64,
) -> f64 {
    let mut sum: f64 = components.iter().map(|(data, x)| x * x * value(data, data)).sum();
    for (i, j, binary) in pairs(components) {
        let ((first, x), (second, y)) = (components[i], components[j]);
        let [beta, gamma] = parameters(binary);
        sum += 2.0 * x * y * beta * gamma * (x + y) / (beta * beta * x + y) * value(first, second);
    }
    sum
}

fn owned<T: Clone>(values: impl Iterator<Item = T>) -> Cow<'static, [T]> {
    Cow::Owned(values.collect())
}

impl Mixture {
    /// The mixture as data of one fluid.
    pub(in crate::fluid) fn data(&self) -> FluidData {
        let components = self.components;
        let mean =
            |value: fn(&FluidData) -> f64| components.iter().map(|(data, x)| x * value(data)).sum::<f64>();
        let reducing_temperature_k = reducing(
            components,
            |b| b.temperature,
            |one, other| libm::sqrt(one.reducing_temperature_k * other.reducing_temperature_k),
        );
        let volume = reducing(
            components,
            |b| b.volume,
            |one, other| {
                let lengths = libm::cbrt(one.reducing_density_mol_m3).recip()
                    + libm::cbrt(other.reducing_density_mol_m3).recip();
                lengths * lengths * lengths / 8.0
            },
        );
        let (reducing_density_mol_m3, molar_mass_kg_mol) =
            (volume.recip(), mean(|data| data.molar_mass_kg_mol));
        // Ideal parts count with `share` = x R_i / R, their tau is `scale` times that of the mixture.
        let shares = || {
            components.iter().map(move |&(data, x)| {
                let share = x * data.gas_constant_j_mol_k / GAS_CONSTANT_J_MOL_K;
                (data, share, data.reducing_temperature_k / reducing_temperature_k)
            })
        };
        let dilution: f64 = components
            .iter()
            .map(|(data, x)| x * libm::log(x * reducing_density_mol_m3 / data.reducing_density_mol_m3))
            .sum();
        let cubic = peng_robinson::equivalent(components, GAS_CONSTANT_J_MOL_K);
        FluidData {
            name: self.name,
            also: self.also,
            reference: self.reference,
            gas_constant_j_mol_k: GAS_CONSTANT_J_MOL_K,
            molar_mass_kg_mol,
            reducing_temperature_k,
            reducing_density_mol_m3,
            critical_temperature_k: cubic.temperature_k,
            critical_pressure_pa: cubic.pressure_pa,
            acentric_factor: cubic.acentric_factor,
            lowest_temperature_k: self.lowest_temperature_k,
            highest_temperature_k: HIGHEST_TEMPERATURE_K,
            highest_pressure_pa: HIGHEST_PRESSURE_PA,
            triple_liquid_density_mol_m3: mean(|data| data.triple_liquid_density_mol_m3.recip()).recip(),
            melting: Melting { temperature_k: 1.0, pressure_pa: f64::INFINITY, terms: &[] },
            power: owned(components.iter().flat_map(|&(data, x)| {
                data.power.iter().map(move |&term| PowerTerm { n: x * term.n, ..term })
            })),
            gaussian: owned(components.iter().flat_map(|&(data, x)| {
                data.gaussian.iter().map(move |&term| GaussianTerm { n: x * term.n, ..term })
            })),
            nonanalytic: owned(components.iter().flat_map(|&(data, x)| {
                data.nonanalytic.iter().map(move |&term| NonanalyticTerm { n: x * term.n, ..term })
            })),
            departure: owned(pairs(components).into_iter().flat_map(|(i, j, binary)| {
                let x = components[i].1 * components[j].1;
                binary.departure.iter().map(move |&term| D { n: x * term.n, ..term })
            })),
            ideal_constant: dilution
                + shares()
                    .map(|(data, share, scale)| {
                        share * (data.ideal_constant + data.ideal_ln_tau * libm::log(scale))
                    })
                    .sum::<f64>(),
            ideal_tau: shares().map(|(data, share, scale)| share * scale * data.ideal_tau).sum(),
            ideal_ln_tau: shares().map(|(data, share, _)| share * data.ideal_ln_tau).sum(),
            ideal_power: owned(shares().flat_map(|(data, share, scale)| {
                data.ideal_power.iter().map(move |&(n, t)| (share * n * libm::pow(scale, t), t))
            })),
            ideal_einstein: owned(shares().flat_map(|(data, share, scale)| {
                data.ideal_einstein.iter().map(move |&(n, t)| (share * n, scale * t))
            })),
            ideal_general: owned(shares().flat_map(|(data, share, scale)| {
                data.ideal_general.iter().map(move |&(n, t, c, d)| (share * n, scale * t, c, d))
            })),
            transport: Transport::Mixture(Arc::new(MixtureTransport {
                reducing_density_kg_m3: reducing_density_mol_m3 * molar_mass_kg_mol,
                components: components
                    .iter()
                    .map(|&(data, fraction)| MixtureComponent {
                        fraction,
                        molar_mass_kg_mol: data.molar_mass_kg_mol,
                        reducing_density_kg_m3: data.reducing_density_mol_m3 * data.molar_mass_kg_mol,
                        transport: data.transport.clone(),
                    })
                    .collect(),
            })),
        }
    }
}
