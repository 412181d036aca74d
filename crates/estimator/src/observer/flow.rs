//! Gas that flows: mass, gas temperature and rate whatever the rate is, within minutes.
//!
//! The member behind it has a leak rate of either sign, a tenth of the fill in an hour in its standard deviation, that is another one
//! after a quarter of an hour, `dr/dt = -r/tau + w`. The pressure then tells the mass alone; what the gas temperature is, the
//! thermal model says from the wall, with the cooling of the gas that is left by the gas that goes. It is right in a leak, in a loss of minutes and
//! in a tight cylinder, and as precise as the thermal model.
//!
//! Where that model is worst its own covariance does not say: at the mouth of a tunnel the film changes tenfold, composite walls lag
//! inside, gas is in layers. What it cannot know is considered, not estimated (Schmidt): an error of the gas temperature of a
//! part `c` of what the surroundings lately did to the cylinder,
//!
//! `e^2 = max_i (y_i - T_g)^2 + s^2 + (a/c)^2`,   `var T = P_T + c^2 e^2`,   `var m = P_m + (m c e / T)^2`
//!
//! with the readings `y_i` of the thermometers on the surface, `s` the largest change of one between two rows and `a` what competing explanations of a row
//! disagreed on the gas temperature ([`super::surroundings`]), both fading. `c e` is multiplied by `k`, where the observer is told that the surroundings do more
//! ([`Observer::doubt_surroundings`]). Errors that stay,
//! a transmitter's offset above all, are in the masses of all times alike; those of the gas temperature come and go:
//!
//! `var (m - m') per time = m^2 min(P_T/T^2, P_m/m^2) + (m c e / T)^2`.
//!
//! Of that, new since the row before is at most what moved in it or the row before it, and what the gas has taken on of the rest:
//! `dp/dT c (s' + (1 - exp(-dt / tau)) max_i |y_i - T_g|)` of a pressure, with the memory `tau` of `s`.
//!
//! Assumptions: an ideal gas where kelvins become parts of the mass. `c` = 0.2 was set on 700 drawn days of 7 vessels in 10 climates, tight and with
//! losses (`world` of `cylwatch-evaluation`, seeds 9000 to 9009); other seeds judge.
//!
//! Source: Schmidt, Advances in Control Systems 3 (1966) 293; Woodbury, Junkins, AIAA 2010-7752.
use cylwatch_thermal::real::powi;
use serde::{Deserialize, Serialize};

use super::Observer;
use super::settings::FlowDoubt;
use crate::EstimatorError;
use crate::filter::Moments;

/// Mass, gas temperature and rate where gas may flow. SI; `sd` is a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Its sd, kg.
    pub mass_sd_kg: f64,
    /// The part of that sd that is not the same an hour later, kg.
    pub passing_sd_kg: f64,
    /// The part of that which is considered for what the surroundings do, kg.
    pub considered_sd_kg: f64,
    /// Mean gas temperature, K.
    pub gas_mean_k: f64,
    /// Its sd, K.
    pub gas_mean_sd_k: f64,
    /// What goes out, kg/s; negative: what comes in.
    pub rate_kg_s: f64,
    /// Its sd, kg/s.
    pub rate_sd_kg_s: f64,
}

impl Flow {
    pub(super) fn mass(&self) -> Moments {
        (self.mass_kg, self.mass_sd_kg * self.mass_sd_kg)
    }

    pub(super) fn gas(&self) -> Moments {
        (self.gas_mean_k, self.gas_mean_sd_k * self.gas_mean_sd_k)
    }

    pub(super) fn rate(&self) -> Moments {
        (self.rate_kg_s, self.rate_sd_kg_s * self.rate_sd_kg_s)
    }
}

impl Observer {
    /// What the member says whose gas may flow; `None` without one and before the first sample.
    pub fn flow(&self) -> Option<Flow> {
        let index = self.roles.flowing.filter(|&index| index < self.bank.members.len())?;
        let states = self.cylinder.state_map();
        let [(gas_mean_k, gas), (mass_kg, mass), (rate_kg_s, rate)] =
            [states.gas, states.mass, states.leak].map(|state| self.bank.moments(index, state));
        let part = self.cylinder.settings().flow_doubt.part;
        let away_k = libm::hypot(self.farthest_k(gas_mean_k), self.clock.moved_k);
        let considered_k = self.clock.doubt * libm::hypot(part * away_k, self.clock.ambiguous_k);
        let considered = powi(considered_k / gas_mean_k, 2);
        let kg2 = mass_kg * mass_kg;
        let passing = (gas / (gas_mean_k * gas_mean_k)).min(mass / kg2);
        Some(Flow {
            mass_kg,
            mass_sd_kg: libm::sqrt(mass + kg2 * considered),
            passing_sd_kg: libm::sqrt(kg2 * (passing + considered)),
            considered_sd_kg: libm::sqrt(kg2 * considered),
            gas_mean_k,
            gas_mean_sd_k: libm::sqrt(gas + gas_mean_k * gas_mean_k * considered),
            rate_kg_s,
            rate_sd_kg_s: libm::sqrt(rate),
        })
    }

    /// What the error of the gas temperature that may have come since the row before does to a pressure, by the settings alone, Pa; infinite before the first sample.
    ///
    /// # Errors
    /// The state has no such reading.
    pub fn fresh_doubt_pa(&mut self, pressure: usize) -> Result<f64, EstimatorError> {
        let Some(first) = self.bank.members.first() else { return Ok(f64::INFINITY) };
        let gas = self.cylinder.state_map().gas;
        let FlowDoubt { part, memory_s } = self.cylinder.settings().flow_doubt;
        let moved_k = self.clock.moves_k.iter().fold(0.0, |a: f64, b| a.max(*b));
        let taken_on = -libm::expm1(-self.clock.interval_s / memory_s);
        let doubt_k = part * (moved_k + taken_on * self.farthest_k(first.x[gas]));
        self.cylinder.static_reading(pressure, &first.x, Some(&mut self.reference_x))?;
        Ok(doubt_k * self.reference_x[gas].abs())
    }

    /// How far the last readings of thermometers on the surface are from a temperature at most, K; 0 without any.
    fn farthest_k(&self, from_k: f64) -> f64 {
        let readings = self.cylinder.sensors().iter().zip(&self.clock.last_reading);
        readings
            .filter(|(sensor, _)| sensor.is_on_surface())
            .map(|(_, reading)| (reading - from_k).abs())
            .fold(0.0, f64::max)
    }

    /// Remember how far thermometers have moved since their last readings.
    pub(super) fn remember(&mut self, time_s: f64, readings: &[f64]) {
        let Self { clock, cylinder, .. } = self;
        let since_s = clock.time_s.map_or(0.0, |last_s| time_s - last_s);
        let fading = libm::exp(-since_s / cylinder.settings().flow_doubt.memory_s);
        clock.moved_k *= fading;
        clock.ambiguous_k *= fading;
        (clock.moves_k, clock.interval_s) = ([0.0, clock.moves_k[0]], since_s);
        for (sensor, &reading) in readings.iter().enumerate().filter(|(_, reading)| reading.is_finite()) {
            let last = core::mem::replace(&mut clock.last_reading[sensor], reading);
            if cylinder.sensors()[sensor].is_on_surface() {
                // Not a number before the first reading.
                clock.moves_k[0] = clock.moves_k[0].max((reading - last).abs());
                clock.moved_k = clock.moved_k.max(clock.moves_k[0]);
            }
            clock.last_reading_s[sensor] = time_s;
        }
    }
}
