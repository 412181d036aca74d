//! Where residuals without a change come from: runs that are alike and independent of each other.
//!
//! An Ornstein-Uhlenbeck process is drawn exactly at even intervals: `e_n = phi e_{n-1} + sigma sqrt(1 - phi^2) N(0, 1)`, from its
//! stationary distribution.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::statistic::{Noise, Residual};
use crate::{DetectorError, error::positive};

/// An endless supply of residuals without a change, or of whatever else a detector is fed with.
pub trait ResidualSource {
    /// What a detector is fed with.
    type Sample;

    /// Begin run number `run`: the same residuals for the same number, independent ones for another.
    fn begin(&mut self, run: u64);

    /// The next residual of the run.
    fn next_residual(&mut self) -> Self::Sample;
}

/// Residuals of a noise model at even intervals.
#[derive(Clone, Debug)]
pub struct SimulatedNoise {
    noise: Noise,
    interval_s: f64,
    seed: u64,
    random: ChaCha8Rng,
    last: Option<Residual>,
}

impl SimulatedNoise {
    /// Noise sampled every `interval_s`; run 0 has begun.
    ///
    /// # Errors
    /// Noise or interval are not valid.
    pub fn try_new(noise: Noise, interval_s: f64, seed: u64) -> Result<Self, DetectorError> {
        noise.validate()?;
        positive("interval_s", interval_s)?;
        Ok(Self { noise, interval_s, seed, random: ChaCha8Rng::seed_from_u64(seed), last: None })
    }
}

impl ResidualSource for SimulatedNoise {
    type Sample = Residual;

    fn begin(&mut self, run: u64) {
        self.random = ChaCha8Rng::seed_from_u64(self.seed);
        self.random.set_stream(run);
        self.last = None;
    }

    fn next_residual(&mut self) -> Residual {
        let normal: f64 = self.random.sample(StandardNormal);
        let next = match self.last {
            None => Residual { time_s: 0.0, value: self.noise.sd * normal },
            Some(last) => {
                let phi = self.noise.correlation(self.interval_s);
                let value = phi * last.value + self.noise.sd * (1.0 - phi * phi).sqrt() * normal;
                Residual { time_s: last.time_s + self.interval_s, value }
            }
        };
        self.last = Some(next);
        next
    }
}
