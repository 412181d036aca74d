//! Which of two members to believe about the gas temperature: the free one, whose mass may walk at once, or a slow one, whose
//! mass goes only as a slowly changing leak takes it.
//!
//! The slow member is the better thermometer as long as it is right: a mass that stays ties the temperature to the
//! pressure. It is wrong in a fast leak. So both are hypotheses (Magill 1965, multiple model estimation) with
//!
//! `log odds += sum over the readings of (log N(nu_slow; 0, S_slow) - log N(nu_free; 0, S_free))`,
//!
//! which return to prior odds with a memory, so that a gas that leaks no more is trusted again:
//! `odds` decays as `exp(-dt/memory)`. The estimate is the mixture's mean and variance,
//! `x = w x_slow + (1 - w) x_free`, `P = w P_slow + (1 - w) P_free + w (1 - w) (x_slow - x_free)^2`.
use super::member::Innovation;

/// Prior weight of the slow member: fast leaks are rare.
const PRIOR: f64 = 0.95;
/// Memory of the odds, s.
const MEMORY_S: f64 = 7200.0;
/// Bound on the log odds: what a change of hypothesis has to overcome.
const LOG_ODDS_BOUND: f64 = 9.0;
/// Normalised square of an innovation beyond which it says no more: a spike is no leak.
const LARGEST_SQUARE: f64 = 25.0;

/// Weight of the slow member against the free one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Belief {
    log_odds: f64,
}

impl Belief {
    /// As before any reading.
    pub fn new() -> Self {
        Self { log_odds: prior_log_odds() }
    }

    /// Weight of the slow member.
    pub fn weight(&self) -> f64 {
        1.0 / (1.0 + (-self.log_odds).exp())
    }

    /// Take in the innovations of both members after `dt_s`, s.
    pub fn update(&mut self, dt_s: f64, slow: &[Innovation], free: &[Innovation]) {
        let prior = prior_log_odds();
        self.log_odds = prior + (self.log_odds - prior) * (-dt_s / MEMORY_S).exp();
        for (slow, free) in slow.iter().zip(free) {
            if slow.s.is_finite() && free.s.is_finite() {
                self.log_odds += log_likelihood(slow) - log_likelihood(free);
            }
        }
        self.log_odds = self.log_odds.clamp(-LOG_ODDS_BOUND, LOG_ODDS_BOUND);
    }

    /// Mean and variance of the mixture of `(mean, variance)` of the slow and the free member.
    pub fn blend(&self, slow: (f64, f64), free: (f64, f64)) -> (f64, f64) {
        let w = self.weight();
        let apart = slow.0 - free.0;
        (free.0 + w * apart, w * slow.1 + (1.0 - w) * free.1 + w * (1.0 - w) * apart * apart)
    }
}

fn prior_log_odds() -> f64 {
    (PRIOR / (1.0 - PRIOR)).ln()
}

fn log_likelihood(innovation: &Innovation) -> f64 {
    -0.5 * (innovation.s.ln() + (innovation.nu * innovation.nu / innovation.s).min(LARGEST_SQUARE))
}
