//! Change statistics: residuals in, one number out that grows when their mean has changed.
//!
//! Every statistic is a plain value: `update` depends on nothing but the state and the sample, takes constant time
//! and bounded memory, and the state can be saved (serde) and restored at any sample. A sample that is not finite is
//! no sample and leaves the state as it is. When a number is large enough, and what happens then, is not the
//! statistic's business but that of an [`Alarm`]; the threshold comes from [`crate::calibrate`].
//!
//! | statistic | for a change that is | samples |
//! |---|---|---|
//! | [`Shewhart`] | large | independent, unit variance |
//! | [`Cusum`], [`TwoSidedCusum`] | a step of known size | independent, unit variance |
//! | [`ShiryaevRoberts`] | a step of known size, long after the start | independent, unit variance |
//! | [`Ewma`] | a step, size roughly known | independent, unit variance; uneven intervals |
//! | [`Sprt`] | there or not from the first sample on | independent, unit variance |
//! | [`Glr`] | a step or a ramp of unknown size and onset | white or Ornstein-Uhlenbeck, any intervals |
//! | [`FailureGlr`] | a failure of a linear system, seen in the innovations of its Kalman filter | any |
//!
//! Correlated residuals destroy the false-alarm rate of the first five: at a correlation of 0.9 from sample to
//! sample a CUSUM designed for 5.7 million samples alarms every 200. [`Whitener`] makes such residuals independent.
mod alarm;
mod cusum;
mod ewma;
mod failure;
mod glr;
mod noise;
mod shewhart;
mod shiryaev_roberts;
mod sprt;

use serde::{Deserialize, Serialize};

pub use alarm::{AfterAlarm, Alarm, Judgement, Watch};
pub use cusum::{Cusum, TwoSidedCusum};
pub use ewma::{Ewma, EwmaLimits};
pub use failure::{Failure, FailureFinding, FailureGlr, FilterStep};
pub use glr::{Finding, Glr, GlrSettings, OnsetGrid, OnsetHypothesis, Refined, Shape};
pub use noise::{Noise, Whitened, Whitener};
pub use shewhart::Shewhart;
pub use shiryaev_roberts::ShiryaevRoberts;
pub(crate) use shiryaev_roberts::softplus;
pub use sprt::{Sprt, SprtDecision};

/// A statistic of scalar residuals.
pub trait Statistic {
    /// What it is fed with: `f64` where only the order counts, [`Residual`] where the time counts too.
    type Sample: Copy;

    /// Take a sample; the statistic after it. A sample that is not finite changes nothing.
    fn update(&mut self, sample: Self::Sample) -> f64;

    /// The statistic after the last sample.
    fn value(&self) -> f64;

    /// Forget all samples.
    fn reset(&mut self);
}

/// A residual and its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Residual {
    /// Time, s.
    pub time_s: f64,
    /// Residual in its own unit.
    pub value: f64,
}

/// Which changes of the mean count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// Only upwards.
    Above,
    /// Only downwards.
    Below,
    /// Either way.
    #[default]
    Both,
}

impl Side {
    /// The value as this side sees it: itself, its negative, or its magnitude.
    pub(crate) fn of(self, value: f64) -> f64 {
        match self {
            Self::Above => value,
            Self::Below => -value,
            Self::Both => value.abs(),
        }
    }
}

/// Log-likelihood ratio of a normal sample of unit variance: mean `shift` against mean 0.
///
/// `ln(f1/f0) = shift (x - shift/2)`
pub fn log_likelihood_ratio(value: f64, shift: f64) -> f64 {
    shift * (value - 0.5 * shift)
}
