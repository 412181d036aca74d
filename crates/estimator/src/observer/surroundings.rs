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
//! Assumptions: at most one step between two rows, so that none is tried where more are expected (after a gap of 17 h); the extended filter.
//!
//! Source: multiple-model estimation with pruning to one model, Bar-Shalom, Li, Kirubarajan, Estimation with Applications to
//! Tracking and Navigation (2001), section 11.6.
use core::f64::consts::FRAC_2_PI;
use cylwatch_thermal::real::powi;

use super::Observer;
use super::settings::AirStep;
use crate::EstimatorError;

/// Nothing stepped; the air did, and the wind rose by so much, in what it changes by.
const EXPLANATIONS: [Option<f64>; 4] = [None, Some(0.0), Some(1.0), Some(-1.0)];

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
        self.cylinder.write_warm_start(&mut self.start_before);
        self.move_on(dt_s)?;
        let Some(way) = self.surprise(step.surprise_sd, readings)? else {
            return self.take_in(time_s, readings);
        };
        let with_wind = self.cylinder.state_map().outside.is_some();
        let tried = if with_wind { &EXPLANATIONS[..] } else { &EXPLANATIONS[..2] };
        let changed = -2.0 * libm::log(-libm::expm1(-step.per_s * dt_s) / (tried.len() - 1) as f64);
        let mut found = [(f64::INFINITY, 0.0); EXPLANATIONS.len()];
        let (mut stays, mut likeliest) = (Ok(()), None);
        for (index, explanation) in tried.iter().enumerate() {
            let stepped = match explanation {
                None => self.take_in(time_s, readings),
                _ => self.step_as(*explanation, (step, way), dt_s, time_s, readings),
            };
            if stepped.is_ok() && self.is_possible() {
                let prior = explanation.map_or(2.0 * step.per_s * dt_s, |_| changed);
                found[index] = (self.unlikeliness(readings) + prior, self.gas_k());
                likeliest = likeliest.filter(|&best: &usize| found[best].0 <= found[index].0).or(Some(index));
            }
            if index == 0 {
                stays = stepped;
            }
        }
        let Some(likeliest) = likeliest else { return stays };
        if likeliest + 1 < tried.len() {
            // Once more: to keep what it was would take as much memory as the bank.
            self.step_as(tried[likeliest], (step, way), dt_s, time_s, readings)?;
            self.is_possible();
        }
        let (least, likeliest_k) = found[likeliest];
        let (mut sum, mut square) = (0.0, 0.0);
        for (unlikeliness, gas_k) in found {
            let likelihood = libm::exp(0.5 * (least - unlikeliness));
            sum += likelihood;
            square += likelihood * powi(gas_k - likeliest_k, 2);
        }
        self.clock.ambiguous_k = self.clock.ambiguous_k.max(libm::sqrt(square / sum));
        Ok(())
    }

    /// Move on from before the row and take readings as one explanation has it.
    fn step_as(
        &mut self,
        explanation: Option<f64>,
        (step, way): (AirStep, f64),
        dt_s: f64,
        time_s: f64,
        readings: &[f64],
    ) -> Result<(), EstimatorError> {
        self.bank.copy_from(&self.before);
        self.cylinder.model().set_warm_start(&self.start_before);
        if let Some(wind) = explanation {
            self.step_the_surroundings(step, way, wind);
        }
        self.move_on(dt_s)?;
        self.take_in(time_s, readings)
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
