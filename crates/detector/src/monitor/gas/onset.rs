//! Rate and onset of a leak, with intervals, from what the observer says of every possible onset.
//!
//! For an onset at `nu_k` the observer has the rate `r_k` with standard deviation `s_k` ([`Observer::onsets`]), and the evidence knows what those are too small by
//! (`Evidence::error_sd`) and what is considered for the surroundings. With a flat prior on the onset, and a rate that is uniform in its logarithm over
//! four decades, the posterior is a mixture over the onsets of normal distributions cut off at zero,
//!
//! `p(r, nu_k) ~ dt_k s_k/max(r_k, s_k) exp(r_k^2/(2 s_k^2)) N(r; r_k, s_k^2)`,
//!
//! whose quantiles are the intervals; the mean of the likelihood ratio over onsets and rates is the Bayes factor of a leak. A prior that is flat
//! in the rate would prefer fast leaks of the last hours to slow ones of days. An error of the rate that no innovation shows, such as the slow
//! drift of what the observer has learnt, widens the rate by a standard deviation of its own, 0.01 g/h of 4.5 kg, as does what a kilogram is worth in the
//! observer's model, 1 % (of 125 leaks in seven vessels and six climates the 95 % intervals then hold 95 %); the onset by ten minutes, since the mass follows a leak by some.
//!
//! Assumes one leak of constant rate since its onset. Onsets are half a day apart when they are two days old: what speaks for one speaks for all from the one before it to the
//! one after it, the less the farther.
//!
//! Source: Bayesian mixture over change points, D. A. Stephens, Appl. Stat. 43 (1994) 159; D. V. Hinkley, Biometrika 56 (1969) 495.
//!
//! [`Observer::onsets`]: crate::estimator::observer::Observer::onsets
use core::f64::consts::TAU;
use cylwatch_estimator::thermal::real::powi;
use smallvec::SmallVec;

use crate::estimator::observer::{ONSETS_AT_MOST, Observer, Onset};
use crate::evidence::Evidence;
use crate::monitor::{Interval, LeakFinding};
use crate::prognosis::{normal_probability, root};

/// Probability on either side of an interval.
const TAIL: f64 = 0.025;
/// What is left of a quantile, as a part of its range, or of a probability where one is found.
const FOUND: (f64, f64) = (1e-10, 1e-10);
/// Weight of an onset that adds nothing.
const NEGLIGIBLE: f64 = 1e-6;
/// Decades over which a leak rate may be anything, as a natural logarithm: 0.001 to 10 bar/h.
const LN_RATES: f64 = 9.21;
/// Relative error of what a kilogram is worth in the observer's model, standard deviation.
const MODEL: f64 = 0.01;
/// Error of the rate that lasts, as a part of the mass, 1/s.
const DRIFT_PER_S: f64 = 1e-5 / 4.477 / 3600.0;
/// By how much an onset may be off beside what is known of it, s.
const ONSET_S: f64 = 600.0;

/// What is known of a leak, if there is one: a mixture over its onsets. Quantiles are found when they are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    candidates: SmallVec<[Candidate; ONSETS_AT_MOST]>,
    /// Time at which it is known, s.
    time_s: f64,
    /// Error of the rate that lasts, kg/s.
    drift_kg_s: f64,
    /// Logarithm of the Bayes factor of a leak, its rate anywhere in four decades and its onset at any time, against none.
    pub log_bayes_factor: f64,
    /// Whether any onset makes a loss likelier than none.
    pub speaks_for_a_loss: bool,
}

/// One onset with its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Candidate {
    /// Onset, the one before it and the one after it, s.
    onset_s: f64,
    from_s: f64,
    to_s: f64,
    rate: f64,
    sd: f64,
    weight: f64,
}

/// Rate and onset of a leak at a time, s, of a cylinder that holds so much, kg, if there is one; `None`: too little has been seen.
pub fn fit(observer: &Observer, evidence: &Evidence, time_s: f64, mass_kg: f64) -> Option<Posterior> {
    let error_sd = evidence.error_sd();
    let onset = |of: Onset| {
        let considered_kg_s = evidence.considered_kg_s(time_s - of.since_s);
        (of.since_s, of.rate_kg_s, libm::hypot(error_sd * of.sd_kg_s, considered_kg_s))
    };
    let onsets: SmallVec<[_; ONSETS_AT_MOST]> = observer.onsets().map(onset).collect();
    Posterior::of(&onsets, time_s, DRIFT_PER_S * mass_kg)
}

impl Posterior {
    /// Of onsets, s, with their rates and standard deviations, kg/s, oldest first, and an error of the rate that lasts, kg/s.
    pub(super) fn of(onsets: &[(f64, f64, f64)], time_s: f64, drift_kg_s: f64) -> Option<Self> {
        let mut candidates: SmallVec<[Candidate; ONSETS_AT_MOST]> = onsets
            .iter()
            .enumerate()
            .map(|(index, &(onset_s, rate, sd))| {
                let from_s = index.checked_sub(1).map_or(onset_s, |before| onsets[before].0);
                let to_s = onsets.get(index + 1).map_or(time_s, |after| after.0);
                Candidate { onset_s, from_s, to_s, rate, sd, weight: 0.0 }
            })
            .collect();
        let ratio = |one: &Candidate| 0.5 * powi(one.rate.max(0.0) / one.sd, 2);
        let largest = candidates.iter().map(ratio).fold(0.0, f64::max);
        let (mut total, mut factor, mut span_s) = (0.0, 0.0, 0.0);
        for one in &mut candidates {
            let width = 0.5 * (one.to_s - one.from_s);
            let likelihood = libm::exp(ratio(one) - largest);
            // Mean of the likelihood over rates that are uniform in their logarithm.
            let mean = likelihood * libm::sqrt(TAU) * one.sd / (one.rate.max(one.sd) * LN_RATES);
            factor += width * mean;
            // What lies above zero of a normal distribution of the rate.
            one.weight = width * mean * normal_probability(one.rate / one.sd);
            total += one.weight;
            span_s += width;
        }
        candidates.iter_mut().for_each(|one| one.weight /= total);
        let log_bayes_factor = largest + libm::log(factor / span_s);
        if !(total > 0.0 && log_bayes_factor.is_finite()) {
            return None;
        }
        Some(Self { candidates, time_s, drift_kg_s, log_bayes_factor, speaks_for_a_loss: largest > 0.0 })
    }

    fn rates(&self) -> Mixture {
        Mixture::new(&self.candidates, |one| (one.rate, libm::hypot(one.rate_sd(), self.drift_kg_s)))
    }

    /// Leak rate, kg/s.
    pub(crate) fn rate_kg_s(&self) -> Interval {
        self.rates().interval()
    }

    /// What the rate is below with 97.5 %, kg/s: the upper end of [`Posterior::rate_kg_s`].
    pub(crate) fn largest_rate_kg_s(&self) -> f64 {
        self.rates().quantile(1.0 - TAIL)
    }

    /// Onset, s.
    pub(crate) fn onset_s(&self) -> Interval {
        let onset = |p: f64| onset_quantile(&self.candidates, p, self.time_s);
        Interval {
            value: onset(0.5),
            low: onset(TAIL) - ONSET_S,
            high: (onset(1.0 - TAIL) + ONSET_S).min(self.time_s),
        }
    }

    /// Mass lost since the onset, kg.
    pub(crate) fn lost_kg(&self) -> Interval {
        let losses = Mixture::new(&self.candidates, |one| {
            let age_s = self.time_s - one.onset_s;
            (one.rate * age_s, one.rate_sd() * age_s)
        });
        losses.interval()
    }

    /// The leak, its rate also as loss of the pressure at 15 °C, of which a kilogram makes `pa_per_kg`.
    pub(crate) fn finding(&self, pa_per_kg: f64) -> LeakFinding {
        let rate_kg_s = self.rate_kg_s();
        LeakFinding {
            rate_kg_s,
            rate_pa_s: rate_kg_s.scaled(pa_per_kg),
            onset_s: self.onset_s(),
            lost_kg: self.lost_kg(),
        }
    }
}

/// Normal distribution above zero.
#[derive(Clone, Copy, Debug)]
struct Part {
    weight: f64,
    mean: f64,
    sd: f64,
    /// What a normal distribution has below zero.
    cut: f64,
}

impl Part {
    fn new(weight: f64, (mean, sd): (f64, f64)) -> Self {
        Self { weight, mean, sd, cut: normal_probability(-mean / sd) }
    }

    /// Probability of less than `value`.
    fn below(&self, value: f64) -> f64 {
        let above = (1.0 - self.cut).max(f64::MIN_POSITIVE);
        self.weight * (normal_probability((value - self.mean) / self.sd) - self.cut).max(0.0) / above
    }
}

/// Mixture of normal distributions above zero.
struct Mixture {
    parts: SmallVec<[Part; ONSETS_AT_MOST]>,
}

impl Mixture {
    fn new(candidates: &[Candidate], of: impl Fn(&Candidate) -> (f64, f64)) -> Self {
        let counted = candidates.iter().filter(|one| one.weight > NEGLIGIBLE);
        Self { parts: counted.map(|one| Part::new(one.weight, of(one))).collect() }
    }

    fn quantile(&self, p: f64) -> f64 {
        let high = self.parts.iter().map(|part| part.mean.max(0.0) + 10.0 * part.sd).fold(0.0, f64::max);
        quantile(p, (0.0, high), |value| self.parts.iter().map(|part| part.below(value)).sum())
    }

    fn interval(&self) -> Interval {
        Interval { value: self.quantile(0.5), low: self.quantile(TAIL), high: self.quantile(1.0 - TAIL) }
    }
}

/// Quantile of the onset, s: a mixture of triangles.
fn onset_quantile(candidates: &[Candidate], p: f64, time_s: f64) -> f64 {
    let first_s = candidates.first().map_or(time_s, |first| first.from_s);
    quantile(p, (first_s, time_s), |value_s| candidates.iter().map(|one| one.onset_before(value_s)).sum())
}

impl Candidate {
    /// Standard deviation of the rate with what a kilogram is worth, kg/s.
    fn rate_sd(&self) -> f64 {
        libm::hypot(self.sd, MODEL * self.rate)
    }

    /// Probability of an onset before `value_s`.
    fn onset_before(&self, value_s: f64) -> f64 {
        let (rise_s, fall_s) = (self.onset_s - self.from_s, self.to_s - self.onset_s);
        let of_weight = if value_s <= self.from_s {
            0.0
        } else if value_s >= self.to_s {
            1.0
        } else if value_s < self.onset_s {
            powi(value_s - self.from_s, 2) / (rise_s * (rise_s + fall_s))
        } else {
            1.0 - powi(self.to_s - value_s, 2) / (fall_s * (rise_s + fall_s))
        };
        self.weight * of_weight
    }
}

/// Where a distribution, of which `below` gives what is below a value, reaches a probability between two values.
fn quantile(p: f64, (low, high): (f64, f64), below: impl Fn(f64) -> f64) -> f64 {
    let value = |part: f64| low + part * (high - low);
    let excess = |part: f64| below(value(part)) - p;
    value(root(excess, [0.0, 1.0].map(|end| (end, excess(end))), FOUND))
}

#[cfg(test)]
mod tests;
