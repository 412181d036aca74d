//! How uncertain the mean gas temperature is said to be.
//!
//! A filter's noise is tuned for its estimate: it stands for sun, gusts and heat flows that a few nodes do not know, and is
//! there at rest too, when nothing disturbs the cylinder. As long as the cylinder has not been learnt, that noise keeps
//! offsets, couplings and the transmitter's coefficient apart, and the variance `P` of the gas temperature is too large by about
//! the same amount whatever the course. What is stated is
//!
//! `max(P - l d^2, min(P, b^2 + m^2))`
//!
//! with the part `l` of its prior variance that is left of the inside film, `d` the amount ([`BandSettings::overstated_k`]), `b`
//! what no data tell, the offset that thermometers on the surface have together, `1/b^2 = sum 1/b_i^2`, and `m` the error of the
//! model ([`BandSettings::model_k`]). It never exceeds `P`, is about `P` where `P` is large, and nearly so once learnt.
//!
//! Assumption: `d` and `m` were fitted on drawn cylinders in a chamber, with three sensors of typical offsets and with exact
//! thermometers. They say nothing of a vessel or a course of another kind.
use super::band_settings::BandSettings;
use super::settings::ObserverSettings;
use super::states::States;
use crate::sensor::{ParameterKind, Sensor};
use cylwatch_thermal::real::powi;

/// The rule with its numbers for one cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Band {
    /// State and prior variance of the inside film, if it is learnt.
    film: Option<(usize, f64)>,
    overstated_k2: f64,
    /// Variance that is left whatever has been overstated, K².
    least_k2: f64,
}

impl Band {
    pub(super) fn new(states: &States, sensors: &[Sensor], settings: &ObserverSettings) -> Self {
        let certainty_per_k2: f64 = sensors
            .iter()
            .filter(|sensor| sensor.is_on_surface())
            .flat_map(|sensor| sensor.parameters())
            .filter(|parameter| parameter.kind == ParameterKind::Offset)
            .map(|parameter| (parameter.sd * parameter.sd).recip())
            // A sum of nothing would be -0, and its inverse minus infinity.
            .fold(0.0, core::ops::Add::add);
        let BandSettings { overstated_k, model_k } = settings.band;
        Self {
            film: states.inside.map(|state| (state, powi(settings.ln_inside_film.prior_sd, 2))),
            overstated_k2: overstated_k * overstated_k,
            least_k2: certainty_per_k2.recip() + model_k * model_k,
        }
    }

    /// Stated variance of the gas temperature, K², from the filter's, and the filter's variance of each state.
    pub(super) fn stated_k2(&self, gas_k2: f64, variance: impl Fn(usize) -> f64) -> f64 {
        let left = match self.film {
            Some((state, prior)) if prior > 0.0 => (variance(state) / prior).min(1.0),
            _ => 0.0,
        };
        (gas_k2 - left * self.overstated_k2).max(gas_k2.min(self.least_k2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::cylinder::Cylinder;
    use crate::thermal::vessel::presets;
    use approx::assert_relative_eq;

    const FILM_SD: f64 = 0.25;
    /// Class B at 20 °C, anywhere within 0.3 K + 0.005 times 20 K.
    const OFFSET_K2: f64 = 0.4 * 0.4 / 3.0;

    fn band(names: &[&str], settings: &ObserverSettings) -> Band {
        let sensors: Vec<Sensor> = names.iter().map(|name| Sensor::typical(name).unwrap()).collect();
        let cylinder = Cylinder::new(&presets::load("nitrogen-20l").unwrap(), &sensors, settings).unwrap();
        Band::new(cylinder.state_map(), &sensors, settings)
    }

    fn usual() -> Band {
        band(&["shoulder", "valve", "pressure"], &ObserverSettings::default())
    }

    #[test]
    fn a_cold_cylinder_is_stated_better_than_the_filter_says_and_a_learnt_one_as_it_says() {
        let stated = |film_sd: f64| usual().stated_k2(0.3, |_| film_sd * film_sd);
        assert_relative_eq!(stated(FILM_SD), 0.3 - 0.16, max_relative = 1e-12);
        assert_relative_eq!(stated(0.5 * FILM_SD), 0.3 - 0.25 * 0.16, max_relative = 1e-12);
        assert_relative_eq!(stated(0.0), 0.3, max_relative = 1e-12);
        // A film that walks further than its prior tells no more than one that has not been learnt.
        assert_relative_eq!(stated(2.0 * FILM_SD), stated(FILM_SD), max_relative = 1e-12);
    }

    #[test]
    fn no_band_is_narrower_than_thermometers_and_model_allow_or_wider_than_the_filters() {
        // Two thermometers: half of the variance of one.
        let least = 0.5 * OFFSET_K2 + 0.01;
        let stated = |gas_k2: f64| usual().stated_k2(gas_k2, |_| FILM_SD * FILM_SD);
        assert_relative_eq!(stated(0.12), least, max_relative = 1e-12);
        assert_relative_eq!(stated(0.02), 0.02, max_relative = 1e-12);
        assert_relative_eq!(stated(100.0), 100.0 - 0.16, max_relative = 1e-12);
    }

    #[test]
    fn what_has_no_thermometer_no_film_or_no_calibration_is_stated_as_the_filter_says() {
        let settings = ObserverSettings::default();
        let known =
            ObserverSettings { ln_inside_film: crate::observer::Walk::constant(0.0), ..settings.clone() };
        let plain = ObserverSettings { band: BandSettings::NONE, ..settings.clone() };
        let names = ["shoulder", "pressure"];
        for band in [band(&["ambient", "pressure"], &settings), band(&names, &known), band(&names, &plain)] {
            assert_relative_eq!(band.stated_k2(0.3, |_| FILM_SD * FILM_SD), 0.3, max_relative = 1e-12);
        }
    }
}
