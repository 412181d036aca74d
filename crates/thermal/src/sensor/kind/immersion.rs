//! Thermometer in the gas on a stem through the valve, as on-tank valves have: `y = T_gas + kappa (T_valve - T_gas) + b`.
//!
//! The stem conducts heat between its root, which has the valve's temperature, and its tip. As a fin with an adiabatic tip
//! it has the coupling
//!
//! ```text
//! kappa = 1/cosh(m L)        m² = 4 h d / (k (d² - d_i²))
//! ```
//!
//! with length L, diameters d outside and d_i inside, conductivity k and the film h between stem and gas. The film changes with
//! density and motion of the gas, so kappa is uncertain and an observer learns it. Heat stored in the stem is left to the lag.
//!
//! # References
//! [incropera], fins of uniform cross section.
use super::{Bound, Kind, ParameterKind, Prediction, Quantity};
#[cfg(feature = "files")]
use super::{SensorKind, StatedKind, gas};

/// Typical stem: a tube of stainless steel, 40 mm long.
#[cfg(feature = "files")]
const TYPICAL: Stem = Stem {
    length_m: 0.04,
    diameters_m: [6e-3, 4e-3],
    conductivity_w_m_k: 15.0,
    // Natural convection in nitrogen of 200 bar that differs from the wall by 2 K.
    film_w_m2_k: 80.0,
};

pub(super) const KIND: Kind = Kind {
    quantity: Quantity::Temperature,
    predict: |_, exposure, parameters| {
        let (kappa, gas, valve) = (parameters[1], exposure.body_k, exposure.electronics_k);
        Prediction {
            value: gas + kappa * (valve - gas) + parameters[0],
            per_body: 1.0 - kappa,
            per_electronics: kappa,
            per_parameter: [1.0, valve - gas, 0.0],
            ..Prediction::default()
        }
    },
    parameters: &[(
        ParameterKind::Coupling,
        [
            Bound::fraction("stem_coupling", "0 is a stem that conducts no heat, 0.08 a steel tube of 40 mm"),
            Bound::fraction("stem_coupling_sd", "0.06 covers films down to half of the usual one"),
        ],
    )],
    #[cfg(feature = "files")]
    stated: StatedKind {
        name: "immersion",
        keys: &["cell", "height_m", "stem_coupling", "stem_coupling_sd"],
        is_named: |_| false,
        columns: &[],
        build: |table| Ok(SensorKind::Immersion { place: gas::place(table)? }),
        parameters: |spec| vec![[spec.stem_coupling, spec.stem_coupling_sd]],
        coupling: Some(|spec| [&mut spec.stem_coupling, &mut spec.stem_coupling_sd]),
        plausible: |_| gas::INSIDE_K,
        typical: |spec| {
            spec.stem_coupling.get_or_insert(TYPICAL.coupling());
            spec.stem_coupling_sd.get_or_insert(0.06);
            (gas::KIND.stated.typical)(spec);
        },
    },
};

/// A stem and the film around it.
#[cfg(feature = "files")]
struct Stem {
    length_m: f64,
    /// Outside and inside; inside 0: it is solid.
    diameters_m: [f64; 2],
    conductivity_w_m_k: f64,
    film_w_m2_k: f64,
}

#[cfg(feature = "files")]
impl Stem {
    /// Part of the way from gas to valve that its tip is at.
    fn coupling(&self) -> f64 {
        let [outside, inside] = self.diameters_m;
        let m2 = 4.0 * self.film_w_m2_k * outside
            / (self.conductivity_w_m_k * (outside * outside - inside * inside));
        libm::cosh(libm::sqrt(m2) * self.length_m).recip()
    }
}

#[cfg(all(test, feature = "files"))]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A thermometer well of 20 mm outside and 18.8 mm inside of stainless steel, k = 17 W/(m K), in steam, h = 300 W/(m² K):
    /// 34.4 mm make an error of 0.5 % (O. A. Ezekoye, Heat transfer, problem 4.13: m = 174.130 1/m, L = 0.034408 m).
    #[test]
    fn a_thermometer_well_of_34_mm_is_half_a_percent_off() {
        let well = Stem {
            length_m: 0.034_407_876,
            diameters_m: [0.02, 0.0188],
            conductivity_w_m_k: 17.0,
            film_w_m2_k: 300.0,
        };
        assert_relative_eq!(well.coupling(), 0.005, max_relative = 1e-5);
    }

    /// The balance of slices: conduction from neighbour to neighbour, film to the gas, the root at 1, the tip closed.
    #[test]
    fn the_coupling_is_the_tip_of_a_stem_in_slices() {
        const N: usize = 2000;
        let Stem { length_m, diameters_m: [outside, inside], conductivity_w_m_k, film_w_m2_k } = TYPICAL;
        let slice_m = length_m / N as f64;
        let area_m2 = core::f64::consts::FRAC_PI_4 * (outside * outside - inside * inside);
        let conductance_w_k = conductivity_w_m_k * area_m2 / slice_m;
        let to_gas_w_k = film_w_m2_k * core::f64::consts::PI * outside * slice_m;
        // From the tip, where 1 K is above the gas, each slice's heat flow gives the temperature of the one before it.
        let (mut above_k, mut flow_w) = (1.0, 0.0);
        for _ in 0..N - 1 {
            flow_w += to_gas_w_k * above_k;
            above_k += flow_w / conductance_w_k;
        }
        flow_w += to_gas_w_k * above_k;
        let root_k = above_k + 0.5 * flow_w / conductance_w_k;
        assert_relative_eq!(TYPICAL.coupling(), 1.0 / root_k, max_relative = 1e-4);
    }
}
