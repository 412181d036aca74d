//! Steps of the surroundings: what explains a row that surprises every thermometer.
//!
//! Air that walks and a film that walks are right for hours; at the mouth of a tunnel both are others from one row to the next, and a filter
//! linearised at the air of before explains a quick film by air of 100 °C. Where the thermometers on the surface are surprised to one
//! side, the row is taken once for each explanation `h` from the bank of before, and what is likeliest stays:
//!
//! `-2 ln L_h = sum_i (nu_i^2 / S_i + ln S_i) - 2 ln p_h`,
//!
//! with the innovations `nu`, variances `S`, of the first member. Explanations and their prior probabilities `p` in the interval `dt`: none,
//! `exp(-q dt)`, and a step of the air to the side of the surprise, of a normal distribution of its size, with the film outside as it was or by
//! a factor `exp(±f)` another one, `(1 - exp(-q dt)) / 3` each ([`AirStep`]). Of one half of a normal distribution of standard deviation `a`
//! the mean is `a sqrt(2 / pi)`, the variance `a^2 (1 - 2 / pi)`.
//!
//! Assumptions: one step between two rows; the extended filter.
//!
//! Source: the likeliest of several hypotheses on one filter as in Bar-Shalom, Li, Kirubarajan, Estimation with Applications to
//! Tracking and Navigation (2001), section 11.6.
use std::f64::consts::FRAC_2_PI;

use super::Observer;
use super::settings::AirStep;
use crate::EstimatorError;
use crate::sensor::SensorKind;

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
        let stays = self.take_in(time_s, readings);
        if stays.is_ok() && self.is_possible() {
            least = self.unlikeliness(readings) + 2.0 * step.per_s * dt_s;
            self.likeliest.copy_from(&self.bank);
        }
        let wind: &[f64] =
            if self.cylinder.state_map().outside.is_some() { &[0.0, 1.0, -1.0] } else { &[0.0] };
        let prior = -2.0 * (-(-step.per_s * dt_s).exp_m1() / wind.len() as f64).ln();
        for &change in wind {
            self.bank.copy_from(&self.before);
            self.step_the_surroundings(step, way, change);
            let stepped = self.move_on(dt_s).and_then(|()| self.take_in(time_s, readings));
            if stepped.is_err() || !self.is_possible() {
                continue;
            }
            let unlikeliness = self.unlikeliness(readings) + prior;
            if unlikeliness < least {
                least = unlikeliness;
                self.likeliest.copy_from(&self.bank);
            }
        }
        if least < f64::INFINITY {
            self.bank.copy_from(&self.likeliest);
            return Ok(());
        }
        stays
    }

    /// A step of the air to one side, 1 or -1, and of the wind.
    fn step_the_surroundings(&mut self, step: AirStep, way: f64, wind: f64) {
        let states = self.cylinder.state_map();
        // Mean and variance of one half of a normal distribution.
        self.bank.shift(states.air, way * FRAC_2_PI.sqrt() * step.air_k);
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
        of.map(|(innovation, _)| innovation.nu * innovation.nu / innovation.s + innovation.s.ln()).sum()
    }

    /// To which side, 1 or -1, thermometers on the surface read what the first member does not expect, one by so many standard deviations and
    /// each by half as many: air and wind reach all of them, and what one does alone is its own.
    fn surprise(&mut self, by_sd: f64, readings: &[f64]) -> Result<Option<f64>, EstimatorError> {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (sensor, &reading) in readings.iter().enumerate().filter(|(_, reading)| reading.is_finite()) {
            if matches!(self.cylinder.sensors()[sensor].kind, SensorKind::Surface { .. }) {
                let (nu, s) = self.bank.foresee(&mut self.cylinder, &mut self.shared, (sensor, reading))?;
                let in_sd = nu / s.sqrt();
                (least, most) = (least.min(in_sd), most.max(in_sd));
            }
        }
        let up = most > by_sd && least > 0.5 * by_sd;
        let down = least < -by_sd && most < -0.5 * by_sd;
        Ok(if up { Some(1.0) } else { down.then_some(-1.0) })
    }
}
