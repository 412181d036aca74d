//! Steps of the surroundings: competing explanations of a row that surprises every thermometer.
//!
//! A random walk of the air and of the outside film is right for hours. At the mouth of a tunnel both change from one row to the next, and a filter
//! that is linearised at the air of the row before explains a fast film by air of 100 °C. If all thermometers on the surface deviate to one
//! side, the observer therefore takes the row several times, each time from the state of the row before and with another explanation `h`. The
//! likeliest one stays, by the innovations `nu` of the first member and their variances `S`:
//!
//! `-2 ln L_h = sum_i (nu_i^2 / S_i + ln S_i) - 2 ln p_h`.
//!
//! | explanation | prior probability in an interval `dt` |
//! |---|---|
//! | no step | `exp(-q dt)` |
//! | the air steps to the side of the deviation, the film stays | `(1 - exp(-q dt)) / 3` |
//! | the same, and the film changes by a factor `exp(f)` or `exp(-f)` | the same for each |
//!
//! The size of an air step is normally distributed with standard deviation `a` ([`AirStep`]). Given its sign, its mean is `a sqrt(2 / pi)` and its
//! variance `a^2 (1 - 2 / pi)`.
//!
//! What the explanations disagree on stays in doubt: the spread of their mean gas temperatures about the likeliest one's,
//! `sum_h L_h (T_h - T)^2 / sum_h L_h`, is considered where gas may flow ([`Flow`](super::Flow)) and fades with the memory of what thermometers did.
//!
//! Assumptions: at most one step between two rows; the extended filter.
//!
//! Source: multiple-model estimation with pruning to one model, Bar-Shalom, Li, Kirubarajan, Estimation with Applications to
//! Tracking and Navigation (2001), section 11.6.
use core::f64::consts::FRAC_2_PI;
use cylwatch_thermal::real::powi;

use super::Observer;
use super::settings::AirStep;
use crate::EstimatorError;

impl Observer {
    /// Move on and take readings as the likeliest explanation has it.
    pub(super) fn explain(
        &mut self,
        step: AirStep,
        dt_s: f64,
        time_s: f64,
        readings: &[f64],
    ) -> Result<(), EstimatorError> {
        self.before.copy_from(&self.bank);
        self.move_on(dt_s)?;
        let Some(way) = self.surprise(step.surprise_sd, readings)? else {
            return self.take_in(time_s, readings);
        };
        let mut least = f64::INFINITY;
        let mut explanations = [(f64::INFINITY, 0.0); 4];
        let stays = self.take_in(time_s, readings);
        if stays.is_ok() && self.is_possible() {
            least = self.unlikeliness(readings) + 2.0 * step.per_s * dt_s;
            explanations[0] = (least, self.gas_k());
            self.likeliest.copy_from(&self.bank);
        }
        let wind: &[f64] =
            if self.cylinder.state_map().outside.is_some() { &[0.0, 1.0, -1.0] } else { &[0.0] };
        let prior = -2.0 * libm::log(-libm::expm1(-step.per_s * dt_s) / wind.len() as f64);
        for (&change, explanation) in wind.iter().zip(&mut explanations[1..]) {
            self.bank.copy_from(&self.before);
            self.step_the_surroundings(step, way, change);
            let stepped = self.move_on(dt_s).and_then(|()| self.take_in(time_s, readings));
            if stepped.is_err() || !self.is_possible() {
                continue;
            }
            let unlikeliness = self.unlikeliness(readings) + prior;
            *explanation = (unlikeliness, self.gas_k());
            if unlikeliness < least {
                least = unlikeliness;
                self.likeliest.copy_from(&self.bank);
            }
        }
        if least < f64::INFINITY {
            self.bank.copy_from(&self.likeliest);
            let (mut sum, mut square) = (0.0, 0.0);
            for (unlikeliness, gas_k) in explanations {
                let likelihood = libm::exp(0.5 * (least - unlikeliness));
                sum += likelihood;
                square += likelihood * powi(gas_k - self.gas_k(), 2);
            }
            self.clock.ambiguous_k = self.clock.ambiguous_k.max(libm::sqrt(square / sum));
            return Ok(());
        }
        stays
    }

    /// Mean gas temperature where gas may flow, K: there the pressure does not tell it.
    fn gas_k(&self) -> f64 {
        let member = self.roles.flowing.filter(|&index| index < self.bank.members.len()).unwrap_or_default();
        self.bank.members[member].x[self.cylinder.state_map().gas]
    }

    /// A step of the air to one side, 1 or -1, and of the wind.
    fn step_the_surroundings(&mut self, step: AirStep, way: f64, wind: f64) {
        let states = self.cylinder.state_map();
        // Mean and variance of one half of a normal distribution.
        self.bank.shift(states.air, way * libm::sqrt(FRAC_2_PI) * step.air_k);
        self.bank.inflate(states.air, (1.0 - FRAC_2_PI) * step.air_k * step.air_k);
        if let Some(film) = states.outside {
            self.bank.shift(film, wind * step.ln_outside_film);
            self.bank.inflate(film, 0.25 * step.ln_outside_film * step.ln_outside_film);
        }
    }

    /// Minus twice the logarithm of the likelihood of readings for the first member, but for a constant.
    fn unlikeliness(&self, readings: &[f64]) -> f64 {
        let of =
            self.bank.members[0].innovations.iter().zip(readings).filter(|(_, reading)| reading.is_finite());
        of.map(|(innovation, _)| innovation.nu * innovation.nu / innovation.s + libm::log(innovation.s)).sum()
    }

    /// Side, 1 or -1, to which all thermometers on the surface deviate from what the first member expects: one by at least `by_sd` standard
    /// deviations, the others by half of that. Air and wind reach all of them; a deviation of a single one is its own.
    fn surprise(&mut self, by_sd: f64, readings: &[f64]) -> Result<Option<f64>, EstimatorError> {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (sensor, &reading) in readings.iter().enumerate().filter(|(_, reading)| reading.is_finite()) {
            if self.cylinder.sensors()[sensor].is_on_surface() {
                let (nu, s) =
                    self.bank.innovation_of_first(&mut self.cylinder, &mut self.work, (sensor, reading))?;
                let in_sd = nu / libm::sqrt(s);
                (least, most) = (least.min(in_sd), most.max(in_sd));
            }
        }
        let up = most > by_sd && least > 0.5 * by_sd;
        let down = least < -by_sd && most < -0.5 * by_sd;
        Ok(if up { Some(1.0) } else { down.then_some(-1.0) })
    }
}
