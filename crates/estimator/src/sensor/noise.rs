//! Noise processes, discretised exactly for irregular sampling.
//!
//! * white: independent readings, `v ~ N(0, sd^2)`;
//! * Gauss-Markov: `v' = -v / T + w`, autocovariance `sd^2 exp(-|dt| / T)`. From one reading to the next
//!   `v <- a v + sd sqrt(1 - a^2) n` with `a = exp(-dt / T)`, `n ~ N(0, 1)`;
//! * random walk: `w' = white`, from 0, with `E[w(s) w(t)] = q^2 min(s, t)`.
//!
//! Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation (2001), sections 4.2
//! and 4.3.
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// Standard normal number.
fn normal<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    StandardNormal.sample(rng)
}

/// White noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WhiteNoise {
    /// Standard deviation.
    pub sd: f64,
}

impl WhiteNoise {
    /// Next value.
    pub(crate) fn next<R: Rng + ?Sized>(&self, rng: &mut R) -> f64 {
        self.sd * normal(rng)
    }
}

/// Stationary first-order Gauss-Markov noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussMarkov {
    sd: f64,
    time_s: f64,
    value: Option<f64>,
}

impl GaussMarkov {
    /// Noise with a standard deviation and a correlation time, s, both at least 0.
    pub(crate) fn new(sd: f64, time_s: f64) -> Self {
        Self { sd, time_s, value: None }
    }

    /// Value `elapsed_s` after the one before; the first one comes from the stationary distribution.
    pub(crate) fn next<R: Rng + ?Sized>(&mut self, elapsed_s: f64, rng: &mut R) -> f64 {
        let value = match self.value {
            None => self.sd * normal(rng),
            Some(before) => {
                let x = if self.time_s > 0.0 { elapsed_s / self.time_s } else { f64::INFINITY };
                (-x).exp() * before + self.sd * (-(-2.0 * x).exp_m1()).sqrt() * normal(rng)
            }
        };
        self.value = Some(value);
        value
    }
}

/// Random walk from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomWalk {
    per_sqrt_s: f64,
    value: f64,
}

impl RandomWalk {
    /// A walk whose standard deviation after `t` seconds is `per_sqrt_s sqrt(t)`.
    pub(crate) fn new(per_sqrt_s: f64) -> Self {
        Self { per_sqrt_s, value: 0.0 }
    }

    /// Value `elapsed_s` after the one before.
    pub(crate) fn next<R: Rng + ?Sized>(&mut self, elapsed_s: f64, rng: &mut R) -> f64 {
        self.value += self.per_sqrt_s * elapsed_s.sqrt() * normal(rng);
        self.value
    }
}

#[cfg(test)]
mod tests;
