//! Film between the outer surface and the surroundings: natural convection and cross flow blended, radiation, sun.
//!
//! Natural convection: Churchill and Chu (1975), vertical plate of the vessel's height or horizontal cylinder.
//! Cross flow: Churchill and Bernstein (1977). Blend `h = (h_n^3 + h_f^3)^(1/3)` (Churchill 1977). Air at
//! 1 atm: ideal gas, Sutherland's law for viscosity and conductivity (White, Viscous Fluid Flow, table 1-2),
//! properties at film temperature, valid 200-400 K. Radiation: grey body in a large enclosure.
use crate::fluid::Real;
use crate::transfer::inside::GRAVITY_M_S2;
use crate::units::ATMOSPHERE_PA;
use crate::wall::geometry::Orientation;

/// Stefan-Boltzmann constant, W/(m² K⁴) (CODATA 2018).
#[cfg(feature = "simulate")]
pub(crate) const STEFAN_BOLTZMANN_W_M2_K4: f64 = 5.670_374_419e-8;
/// Temperature difference below which natural convection becomes linear, K.
const FLAT_BELOW_K: f64 = 0.01;
/// Specific gas constant of dry air, J/(kg K), and its heat capacity, J/(kg K).
const AIR_GAS_CONSTANT: f64 = 287.055;
const AIR_HEAT_CAPACITY: f64 = 1006.0;

/// Air at 1 atm: conductivity W/(m K), kinematic viscosity m²/s, Prandtl number.
fn air<D: Real>(temperature_k: D) -> (D, D, D) {
    let ratio = temperature_k / 273.15;
    let root = ratio * ratio.sqrt();
    let viscosity = root * (1.716e-5 * (273.15 + 110.4)) / (temperature_k + 110.4);
    let conductivity = root * (0.0241 * (273.15 + 194.0)) / (temperature_k + 194.0);
    let kinematic = viscosity * temperature_k * (AIR_GAS_CONSTANT / ATMOSPHERE_PA);
    (conductivity, kinematic, viscosity * AIR_HEAT_CAPACITY / conductivity)
}

/// A body in air: what its film depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// How its axis lies.
    pub orientation: Orientation,
    /// Outer diameter, m.
    pub diameter_m: f64,
    /// Outer height along the axis, m.
    pub height_m: f64,
}

/// Film coefficient of convection, W/(m² K), for a surface at `surface_k` in air at `air_k` with wind across the axis.
pub fn convection_w_m2_k<D: Real>(body: &Body, surface_k: D, air_k: f64, wind_m_s: f64) -> D {
    let film_k = (surface_k + air_k) * 0.5;
    let (k, nu, pr) = air(film_k);
    let difference = surface_k - air_k;
    let theta = (difference * difference + FLAT_BELOW_K * FLAT_BELOW_K).sqrt();
    let length = match body.orientation {
        Orientation::Vertical => body.height_m,
        Orientation::Horizontal => body.diameter_m,
    };
    let rayleigh = theta * pr / (film_k * nu * nu) * (GRAVITY_M_S2 * crate::real::powi(length, 3));
    let sixth = rayleigh.powf(1.0 / 6.0);
    let root = match body.orientation {
        Orientation::Vertical => {
            sixth * 0.387 / ((pr.recip() * 0.492).powf(9.0 / 16.0) + 1.0).powf(8.0 / 27.0) + 0.825
        }
        Orientation::Horizontal => {
            sixth * 0.387 / ((pr.recip() * 0.559).powf(9.0 / 16.0) + 1.0).powf(8.0 / 27.0) + 0.60
        }
    };
    let natural = root * root * k / length;
    if wind_m_s <= 0.0 {
        return natural;
    }
    let reynolds = nu.recip() * (wind_m_s * body.diameter_m);
    let bracket = (((pr.recip() * 0.4).powf(2.0 / 3.0)) + 1.0).powf(0.25);
    let nusselt = reynolds.sqrt() * pr.cbrt() * 0.62 / bracket
        * ((reynolds / 282_000.0).powf(5.0 / 8.0) + 1.0).powf(0.8)
        + 0.3;
    let forced = nusselt * k / body.diameter_m;
    (natural.powi(3) + forced.powi(3)).cbrt()
}

/// Net radiation leaving a grey surface in a large enclosure, W/m².
#[cfg(feature = "simulate")]
pub(crate) fn radiation_w_m2<D: Real>(emissivity: f64, surface_k: D, enclosure_k: f64) -> D {
    (surface_k.powi(4) - crate::real::powi(enclosure_k, 4)) * (emissivity * STEFAN_BOLTZMANN_W_M2_K4)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYLINDER: Body = Body { orientation: Orientation::Vertical, diameter_m: 0.204, height_m: 0.85 };

    /// Coefficients computed for the same body by an independent code with CoolProp air (project reference
    /// "peers", section 6); printed with two digits, so within 4 %.
    #[test]
    fn still_air_and_wind_reproduce_published_coefficients() {
        for (theta, h) in [(1.0_f64, 1.6), (5.0, 2.7), (10.0, 3.3), (20.0, 4.0), (30.0, 4.5)] {
            let here: f64 = convection_w_m2_k(&CYLINDER, 288.15 + theta, 288.15, 0.0);
            assert!((here / h - 1.0).abs() < 0.04, "natural at {theta} K: {here} against {h}");
        }
        for (wind, h) in
            [(0.5, 5.5), (1.0, 8.1), (2.0, 12.0), (5.0, 21.0), (10.0, 34.0), (20.0, 56.0), (40.0, 95.0)]
        {
            let here: f64 = convection_w_m2_k(&CYLINDER, 288.65, 288.15, wind);
            assert!((here / h - 1.0).abs() < 0.04, "wind {wind} m/s: {here} against {h}");
        }
    }

    #[test]
    fn black_body_at_300_k_radiates_459_watts_per_square_metre() {
        approx::assert_relative_eq!(radiation_w_m2(1.0, 300.0, 0.0), 459.300, max_relative = 1e-5);
    }

    #[test]
    fn blended_film_is_never_below_either_part() {
        for wind in [0.1, 1.0, 10.0] {
            let still = convection_w_m2_k(&CYLINDER, 300.0, 280.0, 0.0);
            assert!(convection_w_m2_k(&CYLINDER, 300.0, 280.0, wind) > still);
        }
    }
}
