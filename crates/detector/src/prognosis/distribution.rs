//! Distribution of the time until a limit.
//!
//! Mass `m` and leak rate `r` are jointly normal, `r >= 0`. The limit has been reached by the time `t` if the leak rate is at least the one that takes a mass
//! `m` to the limit by then: `r*(m, t) = (m - limit)/t` if the rate stays, `m ln(m/limit)/t` if the leak is choked, and none from the limit downwards. So
//!
//! `F(t) = int f(m) Phi((E[r | m] - r*(m, t))/sd[r | m]) dm / P(r >= 0)`,
//!
//! one smooth integral, to 1e-9. Quantiles are found to 1e-6 of themselves. With a known mass or a known rate it is a normal distribution function; with a straight
//! loss and a rate that is surely positive it is that of a ratio of normal variables. A leak that is there only with a
//! probability mixes in what happens without one: the mass stays.
//!
//! Source: D. V. Hinkley, Biometrika 56 (1969) 635 (ratio); T. R. Chandrupatla, Adv. Eng. Softw. 28 (1997) 145 (root).
use core::f64::consts::{FRAC_1_SQRT_2, TAU};
use cylwatch_estimator::thermal::real::powi;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::quadrature::integrate;
use super::{LossLaw, MassAndLeak};
use crate::{DetectorError, error::positive};

/// Absolute accuracy of a probability, and of one by which a quantile is found.
const TOLERANCE: f64 = 1e-10;
const TOLERANCE_OF_QUANTILES: f64 = 1e-8;
/// What is left of the logarithm of a time, or of the logit of a probability, where a quantile is found.
const FOUND: (f64, f64) = (1e-10, 1e-7);
/// Standard deviations from which a tail is computed by its logarithm.
const FAR: f64 = 5.0;
/// Standard deviations beyond which masses are left out.
const WIDEST: f64 = 9.0;
/// Multiples of the standard deviation between which a normal distribution function rises.
const STEP: [f64; 5] = [-7.0, -2.0, 0.0, 2.0, 7.0];
/// How far from the time that means give a quantile is looked for first, in its logarithm.
const NEAR: f64 = 0.4;
/// `sqrt(2 pi)`.
const SQRT_TAU: f64 = 2.506_628_274_631_000_7;
/// Longest horizon, s: thirty million years.
const LONGEST_S: f64 = 1e15;
/// Earliest time that is told from now, as a part of the horizon.
const EARLIEST: f64 = 1e-12;

/// When a limit is reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Passage {
    /// It has been.
    Reached,
    /// After so many seconds.
    In(f64),
    /// Not within the horizon, perhaps never.
    BeyondHorizon,
    /// Not reached yet; nothing is known of the leak rate.
    Unknown,
}

/// The time left in quantiles: the limit is reached before `p5` with a probability of 5 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantiles {
    /// 5 %.
    pub p5: Passage,
    /// Median.
    pub p50: Passage,
    /// 95 %.
    pub p95: Passage,
    /// What lies beyond it is not told apart, s.
    pub horizon_s: f64,
}

/// Time until the mass is at a limit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prognosis {
    state: MassAndLeak,
    pub(super) limit_kg: f64,
    law: LossLaw,
    leak_probability: f64,
}

impl Prognosis {
    /// From mass and leak rate now to a limit of the mass, given that there is a leak.
    ///
    /// # Errors
    /// The limit is not positive.
    pub fn try_new(state: MassAndLeak, limit_kg: f64, law: LossLaw) -> Result<Self, DetectorError> {
        Ok(Self { state, limit_kg: positive("limit_kg", limit_kg)?, law, leak_probability: 1.0 })
    }

    /// The same where a leak is there only with a probability; without one the mass stays.
    ///
    /// # Errors
    /// It is not between 0 and 1.
    pub(crate) fn with_leak_probability(self, leak_probability: f64) -> Result<Self, DetectorError> {
        if !(0.0..=1.0).contains(&leak_probability) {
            let (setting, bound) = ("leak_probability", "between 0 and 1");
            return Err(DetectorError::Setting { setting, value: leak_probability, bound });
        }
        Ok(Self { leak_probability, ..self })
    }

    /// Probability that the limit is reached within a time, s.
    pub fn probability_within(&self, time_s: f64) -> f64 {
        self.probability_to(TOLERANCE, time_s)
    }

    fn probability_to(&self, tolerance: f64, time_s: f64) -> f64 {
        let time_s = time_s.max(0.0);
        let mut probability = 0.0;
        if self.leak_probability > 0.0 {
            probability += self.leak_probability * self.with_leak(time_s, tolerance);
        }
        if self.leak_probability < 1.0 {
            let MassAndLeak { mass_kg, mass_sd_kg, .. } = self.state;
            probability += (1.0 - self.leak_probability) * below(mass_kg, mass_sd_kg, self.limit_kg);
        }
        probability.clamp(0.0, 1.0)
    }

    /// Time by which the limit is reached with a probability. A horizon above 1e15 s counts as that.
    pub fn quantile(&self, probability: f64, horizon_s: f64) -> Passage {
        Search::new(self, horizon_s).passage(probability)
    }

    /// 5, 50 and 95 % quantile.
    pub fn quantiles(&self, horizon_s: f64) -> Quantiles {
        let mut search = Search::new(self, horizon_s);
        let p50 = search.passage(0.5);
        Quantiles { p5: search.passage(0.05), p50, p95: search.passage(0.95), horizon_s }
    }

    /// `F(t)`, given that there is a leak.
    fn with_leak(&self, time_s: f64, tolerance: f64) -> f64 {
        let MassAndLeak { mass_kg, leak_kg_s, mass_sd_kg, leak_sd_kg_s, .. } = self.state;
        if leak_sd_kg_s == 0.0 {
            let needed_kg = self.law.mass_that_reaches_kg(self.limit_kg, leak_kg_s.max(0.0), time_s);
            return below(mass_kg, mass_sd_kg, needed_kg);
        }
        if mass_sd_kg == 0.0 {
            return self.with_known_mass(time_s);
        }
        self.over_masses(time_s, tolerance)
    }

    /// `P(r >= r*)/P(r >= 0)`, where the known mass needs the rate `r*`.
    fn with_known_mass(&self, time_s: f64) -> f64 {
        let MassAndLeak { mass_kg, leak_kg_s, leak_sd_kg_s, .. } = self.state;
        // The time is inversely proportional to the rate under either law.
        let needed_kg_s = self.law.time_s(mass_kg, 1.0, self.limit_kg) / time_s;
        if mass_kg <= self.limit_kg {
            return 1.0;
        }
        let tail = |rate: f64| ln_upper_tail((rate - leak_kg_s) / leak_sd_kg_s);
        libm::exp(tail(needed_kg_s) - tail(0.0))
    }

    /// The integral over the mass in standard deviations, `u = (m - E[m])/sd[m]`.
    fn over_masses(&self, time_s: f64, tolerance: f64) -> f64 {
        let MassAndLeak { mass_kg, leak_kg_s, mass_sd_kg, leak_sd_kg_s, correlation } = self.state;
        let sd_kg_s = leak_sd_kg_s * libm::sqrt((1.0 - correlation) * (1.0 + correlation));
        // How far the rate to be expected with a mass lies above the one that is needed: concave.
        let above_kg_s = |u: f64| {
            let lost_kg = self.law.time_s(mass_kg + mass_sd_kg * u, 1.0, self.limit_kg);
            let needed_kg_s = if lost_kg > 0.0 { lost_kg / time_s } else { 0.0 };
            leak_kg_s + correlation * leak_sd_kg_s * u - needed_kg_s
        };
        let no_leak = -leak_kg_s / leak_sd_kg_s;
        let ln_all = ln_upper_tail(no_leak);
        // Where there is hardly a leak its probability is a ratio of tails.
        let in_tail = no_leak > FAR;
        let integrand = |u: f64| {
            let above_kg_s = above_kg_s(u);
            if !in_tail || sd_kg_s == 0.0 {
                libm::exp(-0.5 * u * u - ln_all) * below(0.0, sd_kg_s, above_kg_s)
            } else {
                libm::exp(-0.5 * u * u - ln_all + ln_upper_tail(-above_kg_s / sd_kg_s))
            }
        };
        // A leak that is unlikely, but there, goes with other masses.
        let shift = correlation * no_leak.max(0.0);
        let bounds = (shift.min(0.0) - WIDEST, shift.max(0.0) + WIDEST);
        let ends = steps(above_kg_s, sd_kg_s, bounds, (self.limit_kg - mass_kg) / mass_sd_kg);
        let certain = STEP[STEP.len() - 1] * sd_kg_s;
        let panel = |ends: &[f64]| {
            let [from, to] = [ends[0], ends[1]].map(above_kg_s);
            if from < -certain && to < -certain && !in_tail {
                0.0
            } else if from > certain && to > certain {
                SQRT_TAU * between(ends[0], ends[1]) * libm::exp(-ln_all)
            } else {
                integrate(&integrand, ends[0], ends[1], tolerance * SQRT_TAU)
            }
        };
        ends.windows(2).map(panel).sum::<f64>() / SQRT_TAU
    }
}

/// Looks for quantiles, each beginning where those before have come to.
struct Search<'a> {
    prognosis: &'a Prognosis,
    /// Probability now.
    now: f64,
    /// Logarithm of the earliest time that is told from now, s.
    earliest: f64,
    /// Logarithms of times, s, and probabilities, the horizon first; none where there is no horizon.
    known: SmallVec<[(f64, f64); 40]>,
}

impl<'a> Search<'a> {
    fn new(prognosis: &'a Prognosis, horizon_s: f64) -> Self {
        let Prognosis { state, law, limit_kg, .. } = prognosis;
        let now = if state.correlation == 0.0 {
            below(state.mass_kg, state.mass_sd_kg, *limit_kg)
        } else {
            prognosis.probability_to(TOLERANCE_OF_QUANTILES, 0.0)
        };
        let mut search = Self { prognosis, now, earliest: 0.0, known: SmallVec::new() };
        if horizon_s.is_nan() || horizon_s <= 0.0 {
            return search;
        }
        let horizon_s = horizon_s.min(LONGEST_S);
        search.earliest = libm::log(EARLIEST * horizon_s);
        search.excess(libm::log(horizon_s), 0.0);
        let rate_kg_s = if state.leak_kg_s > 0.0 { state.leak_kg_s } else { state.leak_sd_kg_s };
        let about = libm::log(law.time_s(state.mass_kg, rate_kg_s, *limit_kg));
        for ln_s in [about - NEAR, about + NEAR] {
            if ln_s > search.earliest && ln_s < libm::log(horizon_s) {
                search.excess(ln_s, 0.0);
            }
        }
        search
    }

    /// What the probability within a time, by its logarithm, s, is above another one, both as logits: nearly straight there.
    fn excess(&mut self, ln_s: f64, above: f64) -> f64 {
        let probability = self.prognosis.probability_to(TOLERANCE_OF_QUANTILES, libm::exp(ln_s));
        self.known.push((ln_s, probability));
        logit(probability) - above
    }

    fn passage(&mut self, probability: f64) -> Passage {
        if self.now >= probability {
            return Passage::Reached;
        }
        let reached = |of: &(f64, f64)| of.1 >= probability;
        let later = self.known.iter().copied().filter(reached).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((later, then)) = later else { return Passage::BeyondHorizon };
        let earlier = self.known.iter().copied().filter(|of| !reached(of) && of.0 < later);
        let wanted = logit(probability);
        let (earlier, lacking) = match earlier.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((earlier, then)) => (earlier, logit(then) - wanted),
            None => (self.earliest, self.excess(self.earliest, wanted)),
        };
        if lacking >= 0.0 {
            return Passage::In(libm::exp(earlier));
        }
        let ends = [(earlier, lacking), (later, logit(then) - wanted)];
        Passage::In(libm::exp(root(|ln_s| self.excess(ln_s, wanted), ends, FOUND)))
    }
}

/// `ln(p/(1 - p))`, finite for every probability.
fn logit(probability: f64) -> f64 {
    let within = probability.clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON);
    libm::log(within) - libm::log1p(-within)
}

/// Bounds, peak, kink, and both sides of each step.
type Ends = SmallVec<[f64; 4 + 2 * STEP.len()]>;

/// Where the integrand steps, between `low` and `high`, both included: where a concave function with a kink passes multiples of a standard deviation.
/// A step narrow against the panels of a quadrature would be overlooked.
fn steps(concave: impl Fn(f64) -> f64, sd: f64, (low, high): (f64, f64), kink: f64) -> Ends {
    let peak = maximum(&concave, (low, high));
    let mut ends = Ends::from_slice(&[low, kink, peak, high]);
    for level in STEP {
        for side in [low, high] {
            ends.extend(crossing(&concave, level * sd, 0.1 * sd, (side, peak)));
        }
    }
    ends.retain(|end| (low..=high).contains(&*end));
    ends.sort_unstable_by(f64::total_cmp);
    ends.dedup();
    ends
}

/// Where a concave function is largest, by thirds.
fn maximum(concave: &impl Fn(f64) -> f64, (mut low, mut high): (f64, f64)) -> f64 {
    let near = 1e-6 * (high - low);
    if concave(high) >= concave(high - near) {
        return high;
    }
    if concave(low) >= concave(low + near) {
        return low;
    }
    for _ in 0..60 {
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if concave(left) < concave(right) { low = left } else { high = right }
    }
    0.5 * (low + high)
}

/// Where a function passes a level, to a tolerance of the level, between two points; `None` if it does not.
fn crossing(
    f: &impl Fn(f64) -> f64,
    level: f64,
    tolerance: f64,
    (mut from, mut to): (f64, f64),
) -> Option<f64> {
    let start = f(from) > level;
    if (f(to) > level) == start {
        return None;
    }
    for _ in 0..45 {
        let middle = 0.5 * (from + to);
        let value = f(middle);
        if (value - level).abs() <= tolerance {
            return Some(middle);
        }
        if (value > level) == start { from = middle } else { to = middle }
    }
    Some(0.5 * (from + to))
}

/// Probability between two values of a standard normal variable.
fn between(low: f64, high: f64) -> f64 {
    // On the side where it does not cancel.
    if low > 0.0 {
        normal_probability(-low) - normal_probability(-high)
    } else {
        normal_probability(high) - normal_probability(low)
    }
}

/// Distribution function of the standard normal distribution.
pub(crate) fn normal_probability(x: f64) -> f64 {
    0.5 * libm::erfc(-FRAC_1_SQRT_2 * x)
}

/// `P(x <= bound)` of a normal `x`, whose standard deviation may be zero.
fn below(mean: f64, sd: f64, bound: f64) -> f64 {
    if sd > 0.0 { normal_probability((bound - mean) / sd) } else { f64::from(u8::from(mean <= bound)) }
}

/// `ln P(x > z)` of a standard normal `x`; in the tail by the continued fraction of Mills' ratio.
fn ln_upper_tail(z: f64) -> f64 {
    if z < FAR {
        return libm::log(normal_probability(-z));
    }
    let mills = (1..80).rev().fold(z, |fraction, n| z + f64::from(n) / fraction);
    -0.5 * (z * z + libm::log(TAU)) - libm::log(mills)
}

/// Root of a rising function between two points with a change of sign, to a tolerance of one or the other, by Chandrupatla's method: inverse quadratic where that is
/// safe, halving where not.
pub(crate) fn root(mut f: impl FnMut(f64) -> f64, [low, high]: [(f64, f64); 2], found: (f64, f64)) -> f64 {
    let (mut b, mut a) = (low, high);
    let mut c = a;
    let mut share = 0.5;
    for _ in 0..200 {
        let x = a.0 + share * (b.0 - a.0);
        let new = (x, f(x));
        c = if (new.1 > 0.0) == (a.1 > 0.0) { a } else { core::mem::replace(&mut b, a) };
        a = new;
        let best = if a.1.abs() < b.1.abs() { a } else { b };
        let smallest = found.0 / (b.0 - a.0).abs();
        if smallest > 0.5 || best.1.abs() < found.1 {
            return best.0;
        }
        let (xi, phi) = ((a.0 - b.0) / (c.0 - b.0), (a.1 - b.1) / (c.1 - b.1));
        let safe = phi * phi < xi && powi(1.0 - phi, 2) < 1.0 - xi;
        share = if safe {
            let across = (c.0 - a.0) / (b.0 - a.0);
            a.1 / (b.1 - a.1) * c.1 / (b.1 - c.1) + across * a.1 / (c.1 - a.1) * b.1 / (c.1 - b.1)
        } else {
            0.5
        }
        .clamp(smallest, 1.0 - smallest);
    }
    c.0
}
