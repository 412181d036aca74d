//! Rate and onset of a leak from the masses of the last weeks, with intervals.
//!
//! `m(t) = a - r (t - nu)^+ + e(t)`: a level, from the onset `nu` on a loss at the rate `r`, and an error of the observer that is
//! an Ornstein-Uhlenbeck process of known standard deviation `s` and time constant `tau`. A bin less `phi = exp(-dt/tau)` times the one
//! before it, over `s sqrt(1 - phi^2)`, has an independent error. So level and rate are linear for each onset on a bin; the sums over the bins after an onset are
//! suffix sums, so all onsets together cost one pass. With flat priors on level and onset, and a rate that is uniform in its logarithm over four
//! decades, the posterior is a mixture over the onsets `k` of normal distributions cut off at zero,
//!
//! `p(r, nu_k) ~ dt_k sd_k/max(r_k, sd_k) exp(L_k) N(r; r_k, sd_k^2)`, `L_k` the log-likelihood ratio against no leak,
//!
//! whose quantiles are the intervals; the mean of the likelihood ratio over onsets and rates is the Bayes factor of a leak. A prior that is flat
//! in the rate would prefer fast leaks of the last hours to slow ones of days. An error of the rate that no mass shows, such as the slow
//! drift of what the observer has learnt, widens the rate by a standard deviation of its own, as does what a kilogram is worth in the
//! observer's model, 0.5 %; the onset by the length of a bin, since the mass follows a leak by some minutes.
//!
//! A mass whose considered error by the surroundings is above `s` is left out, and `s` grows with what the evidence is divided by.
//!
//! Assumes one leak of constant rate since its onset, and that the errors are as stated. They last from minutes to days: the defaults are one
//! process that stands for all of them, such that intervals hold the truth as often as they say (`long_run -- FOLDER accuracy`).
//!
//! Source: change point of a regression: D. V. Hinkley, Biometrika 56 (1969) 495; Bayesian mixture: D. A. Stephens, Appl. Stat. 43
//! (1994) 159.
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::trace::{Bin, FINE_S, MassTrace};
use crate::DetectorError;
use crate::error::positive;
use crate::monitor::{Interval, LeakFinding};
use crate::prognosis::normal_probability;

/// Probability on either side of an interval.
const TAIL: f64 = 0.025;
/// Weight of an onset that adds nothing.
const NEGLIGIBLE: f64 = 1e-6;
/// Halvings of an interval until its ends are one number in print.
const BISECTIONS: usize = 30;
/// Decades over which a leak rate may be anything, as a natural logarithm: 0.001 to 10 bar/h.
const LN_RATES: f64 = 9.21;
/// Relative error of what a kilogram is worth in the observer's model, standard deviation.
const MODEL: f64 = 0.005;
/// Fewest bins that tell a rate.
const FEWEST: usize = 4;

/// Errors of the observer's mass, for the full 20 L nitrogen cylinder; for another fill they are parts of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MassError {
    /// Standard deviation, kg.
    pub sd_kg: f64,
    /// Time constant, s.
    pub time_s: f64,
    /// Standard deviation of a rate error that lasts, kg/s.
    pub drift_kg_s: f64,
}

impl Default for MassError {
    /// 5 g over 5 h, 0.01 g/h.
    fn default() -> Self {
        Self { sd_kg: 5e-3, time_s: 18_000.0, drift_kg_s: 1e-5 / 3600.0 }
    }
}

impl MassError {
    /// # Errors
    /// A value is not positive and finite.
    pub fn validate(&self) -> Result<(), DetectorError> {
        positive("mass_error.sd_kg", self.sd_kg)?;
        positive("mass_error.time_s", self.time_s)?;
        positive("mass_error.drift_kg_s", self.drift_kg_s).map(drop)
    }

    /// The same of a cylinder that holds so many times as much gas.
    pub fn scaled(self, mass: f64) -> Self {
        Self { sd_kg: mass * self.sd_kg, drift_kg_s: mass * self.drift_kg_s, ..self }
    }
}

/// What the masses say about a leak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    /// Leak rate, kg/s.
    pub rate_kg_s: Interval,
    /// Onset, s.
    pub onset_s: Interval,
    /// Mass lost since the onset, kg.
    pub lost_kg: Interval,
    /// Logarithm of the Bayes factor of a leak, its rate anywhere in four decades and its onset at any time, against none.
    pub log_bayes_factor: f64,
}

/// One onset with its rate.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    /// Onset, s, and the times that are nearer to it than to another one.
    onset_s: f64,
    from_s: f64,
    to_s: f64,
    rate: f64,
    sd: f64,
    log_likelihood_ratio: f64,
    weight: f64,
}

/// Rate and onset of the leak that the trace shows best; `None` where it is too short, or nothing in it speaks for a loss.
pub fn fit(trace: &MassTrace, error: &MassError) -> Option<Fitted> {
    let posterior = posterior(trace, error).filter(|posterior| posterior.speaks_for_a_loss)?;
    let Posterior { candidates, log_bayes_factor, end_s, .. } = posterior;
    let sd = |one: &Candidate| one.sd.hypot(MODEL * one.rate);
    let rates = rates(&candidates, error);
    let losses = Mixture::new(&candidates, |one| {
        let age_s = end_s - one.onset_s;
        (one.rate * age_s, sd(one) * age_s)
    });
    let onset = |p: f64| onset_quantile(&candidates, p);
    let onset_s = Interval {
        value: onset(0.5),
        low: onset(TAIL) - FINE_S,
        high: (onset(1.0 - TAIL) + FINE_S).min(end_s),
    };
    let (rate_kg_s, lost_kg) = (rates.interval(), losses.interval());
    Some(Fitted { rate_kg_s, onset_s, lost_kg, log_bayes_factor })
}

/// Logarithm of the Bayes factor of a leak, and the rate, kg/s, that one is below with 97.5 % if there is one; `None` where the trace is
/// too short to say anything.
pub fn outlook(trace: &MassTrace, error: &MassError) -> Option<(f64, f64)> {
    let posterior = posterior(trace, error)?;
    let largest_kg_s = rates(&posterior.candidates, error).quantile(1.0 - TAIL);
    Some((posterior.log_bayes_factor, largest_kg_s))
}

/// Rates of a leak, with errors that no mass shows.
fn rates(candidates: &[Candidate], error: &MassError) -> Mixture {
    let sd = |one: &Candidate| one.sd.hypot(MODEL * one.rate).hypot(error.drift_kg_s);
    Mixture::new(candidates, |one| (one.rate, sd(one)))
}

/// All onsets with their weights.
struct Posterior {
    candidates: Vec<Candidate>,
    log_bayes_factor: f64,
    /// Whether any onset makes a loss likelier than none.
    speaks_for_a_loss: bool,
    end_s: f64,
}

fn posterior(trace: &MassTrace, error: &MassError) -> Option<Posterior> {
    let bins: Vec<Bin> = trace.bins().copied().collect();
    if bins.len() < FEWEST {
        return None;
    }
    let mut candidates = candidates(&bins, error);
    let largest = candidates.iter().map(|c| c.log_likelihood_ratio).fold(0.0, f64::max);
    let (mut total, mut factor, mut span_s) = (0.0, 0.0, 0.0);
    for one in &mut candidates {
        let width = one.to_s - one.from_s;
        let likelihood = (one.log_likelihood_ratio - largest).exp();
        // Mean of the likelihood over rates that are uniform in their logarithm.
        let mean = likelihood * TAU.sqrt() * one.sd / (one.rate.max(one.sd) * LN_RATES);
        factor += width * mean;
        // What lies above zero of a normal distribution of the rate.
        one.weight = width * mean * normal_probability(one.rate / one.sd);
        total += one.weight;
        span_s += width;
    }
    candidates.iter_mut().for_each(|one| one.weight /= total);
    let end_s = bins[bins.len() - 1].time_s;
    let log_bayes_factor = largest + (factor / span_s).ln();
    let sound = total > 0.0 && log_bayes_factor.is_finite();
    sound.then_some(Posterior { candidates, log_bayes_factor, speaks_for_a_loss: largest > 0.0, end_s })
}

impl Fitted {
    /// The same with the rate as loss of the pressure at 15 °C, of which a kilogram makes `pa_per_kg`.
    pub fn finding(&self, pa_per_kg: f64) -> LeakFinding {
        LeakFinding {
            rate_kg_s: self.rate_kg_s,
            rate_pa_s: self.rate_kg_s.scaled(pa_per_kg),
            onset_s: self.onset_s,
            lost_kg: self.lost_kg,
        }
    }
}

/// Rate and likelihood for an onset at each bin but the last one.
fn candidates(bins: &[Bin], error: &MassError) -> Vec<Candidate> {
    let origin_s = bins[0].time_s;
    // Rows of the whitened regression: level w, time u, mass less the first one y.
    let mut rows = Vec::with_capacity(bins.len());
    let (mut level_level, mut level_mass) = (0.0, 0.0);
    for (index, bin) in bins.iter().enumerate() {
        let (t, y) = (bin.time_s - origin_s, bin.mass_kg - bins[0].mass_kg);
        let (phi, before_t, before_y) = match index.checked_sub(1).map(|before| &bins[before]) {
            None => (0.0, 0.0, 0.0),
            Some(before) => (
                (-(bin.time_s - before.time_s) / error.time_s).exp(),
                before.time_s - origin_s,
                before.mass_kg - bins[0].mass_kg,
            ),
        };
        let scale = (error.sd_kg * (1.0 - phi * phi).sqrt()).recip();
        let row = [(1.0 - phi) * scale, (t - phi * before_t) * scale, (y - phi * before_y) * scale];
        level_level += row[0] * row[0];
        level_mass += row[0] * row[2];
        rows.push(row);
    }
    // Suffix sums: ww, wu, uu, wy, uy.
    let mut sums = [0.0; 5];
    let mut found = Vec::with_capacity(bins.len());
    for index in (0..bins.len() - 1).rev() {
        let [w, u, y] = rows[index + 1];
        for (sum, product) in sums.iter_mut().zip([w * w, w * u, u * u, w * y, u * y]) {
            *sum += product;
        }
        let nu = bins[index].time_s - origin_s;
        let [ww, wu, uu, wy, uy] = sums;
        // The loss is minus the ramp: signature h = -(u - nu w).
        let hh = uu - 2.0 * nu * wu + nu * nu * ww;
        let wh = -(wu - nu * ww);
        let hy = -(uy - nu * wy);
        let information = hh - wh * wh / level_level;
        if information <= 1e-9 * hh {
            continue;
        }
        let rate = (hy - wh * level_mass / level_level) / information;
        let log_likelihood_ratio = if rate > 0.0 { 0.5 * rate * rate * information } else { 0.0 };
        found.push(Candidate {
            onset_s: bins[index].time_s,
            from_s: 0.5 * (bins[index.saturating_sub(1)].time_s + bins[index].time_s),
            to_s: 0.5 * (bins[index].time_s + bins[index + 1].time_s),
            rate,
            sd: information.sqrt().recip(),
            log_likelihood_ratio,
            weight: 0.0,
        });
    }
    found.reverse();
    found
}

/// Mixture of normal distributions above zero.
struct Mixture {
    /// Weight, mean and standard deviation.
    parts: Vec<(f64, f64, f64)>,
}

impl Mixture {
    fn new(candidates: &[Candidate], of: impl Fn(&Candidate) -> (f64, f64)) -> Self {
        let part = |one: &Candidate| {
            let (mean, sd) = of(one);
            (one.weight, mean, sd)
        };
        Self { parts: candidates.iter().filter(|one| one.weight > NEGLIGIBLE).map(part).collect() }
    }

    /// Probability of less than `value`.
    fn below(&self, value: f64) -> f64 {
        let share = |&(weight, mean, sd): &(f64, f64, f64)| {
            let cut = normal_probability(-mean / sd);
            let above = (1.0 - cut).max(f64::MIN_POSITIVE);
            weight * (normal_probability((value - mean) / sd) - cut).max(0.0) / above
        };
        self.parts.iter().map(share).sum()
    }

    fn quantile(&self, p: f64) -> f64 {
        let (mut low, mut high) =
            (0.0, self.parts.iter().map(|(_, mean, sd)| mean.max(0.0) + 10.0 * sd).fold(0.0, f64::max));
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if self.below(middle) < p { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn interval(&self) -> Interval {
        Interval { value: self.quantile(0.5), low: self.quantile(TAIL), high: self.quantile(1.0 - TAIL) }
    }
}

/// Quantile of the onset, uniform around each bin.
fn onset_quantile(candidates: &[Candidate], p: f64) -> f64 {
    let mut sum = 0.0;
    for one in candidates {
        if sum + one.weight >= p && one.weight > 0.0 {
            return one.from_s + (p - sum) / one.weight * (one.to_s - one.from_s);
        }
        sum += one.weight;
    }
    candidates.last().map_or(f64::NAN, |last| last.to_s)
}

#[cfg(test)]
mod tests;
